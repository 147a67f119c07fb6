#include "material/glossy_material.h"

#include <algorithm>

#include "material/microfacet/ggx.h"
#include "material/microfacet/ggx_albedo.h"

namespace velour {
namespace {

class GlossyMaterial final : public Material {
  enum Parameter { kRed, kGreen, kBlue, kAlpha };

 public:
  explicit GlossyMaterial(const GlossyParameters& p) : p_(p) {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    const Rgb given = glm::clamp(p_.color_texture.at(site, p_.color), Rgb(0.0f), Rgb(1.0f));
    const Rgb color = point.filter.diffuse_only ? Rgb(0.0f) : given;
    const float roughness = std::clamp(p_.roughness_texture.at(site, p_.roughness), kMinRoughness, 1.0f);
    point.wv = wv;
    const Rgb scaled = color * Interreflection(p_.lobe, roughness, wv.z).gain(color);
    for (int c = 0; c < 3; ++c) point.parameter[kRed + c] = scaled[c];
    point.parameter[kAlpha] = std::max(roughness * roughness, point.filter.min_alpha);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    const Rgb color(point.parameter[kRed], point.parameter[kGreen], point.parameter[kBlue]);
    const Vec2 alpha(point.parameter[kAlpha]);
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i), h = half_vector(point.wv, l);
      f.set(i, l.z > 0 ? color * lobe(point.wv, l, h, alpha) : Rgb(0.0f));
      pdf.v[i] = pdf_ggx_reflection(point.wv, h, alpha);
    }
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    const Vec2 alpha(point.parameter[kAlpha]);
    wl.fill(u, [&](const Vec2& v) {
      const Vec3 h = sample_ggx_visible_normal(point.wv, alpha, v);
      return 2 * glm::dot(point.wv, h) * h - point.wv;
    });
  }

  float diffuse_share(const PreparedBrdf& /*point*/, const Vec3& /*wl*/, float /*pdf*/) const override { return 0; }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  float lobe(const Vec3& wv, const Vec3& wl, const Vec3& h, const Vec2& alpha) const {
    return p_.lobe == GgxLobe::separable ? ggx_brdf_of_independent_shadows(wv, wl, h, alpha)
                                         : ggx_brdf_without_fresnel(wv, wl, h, alpha);
  }

  const GlossyParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters) {
  return std::make_shared<GlossyMaterial>(parameters);
}

}  // namespace velour
