#include "material/glossy_material.h"

#include <algorithm>

#include "material/microfacet/ggx.h"
#include "material/microfacet/ggx_albedo.h"
#include "material/principled/principled_point.h"

namespace velour {
namespace {

class PreparedGlossy final : public PreparedBrdf {
 public:
  PreparedGlossy(const GlossyParameters& p, const Vec3& wv, const SurfaceSite& site, const LobeFilter& filter)
      : wv_(wv), lobe_(p.lobe) {
    const Rgb given = glm::clamp(p.color_texture.at(site, p.color), Rgb(0.0f), Rgb(1.0f));
    const Rgb color = filter.diffuse_only ? Rgb(0.0f) : given;
    const float roughness = std::clamp(p.roughness_texture.at(site, p.roughness), kMinRoughness, 1.0f);
    color_ = color * Interreflection(p.lobe, roughness, wv.z).gain(color);
    alpha_ = Vec2(std::max(roughness * roughness, filter.min_alpha));
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i), h = half_vector(wv_, l);
      f.set(i, l.z > 0 ? color_ * lobe(l, h) : Rgb(0.0f));
      pdf.v[i] = pdf_ggx_reflection(wv_, h, alpha_);
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) {
      const Vec3 h = sample_ggx_visible_normal(wv_, alpha_, v);
      return 2 * glm::dot(wv_, h) * h - wv_;
    });
  }

  float diffuse_share(const Vec3& /*wl*/, float /*pdf*/) const override { return 0; }

 private:
  float lobe(const Vec3& wl, const Vec3& h) const {
    return lobe_ == GgxLobe::separable ? ggx_brdf_of_independent_shadows(wv_, wl, h, alpha_)
                                       : ggx_brdf_without_fresnel(wv_, wl, h, alpha_);
  }

  Vec3 wv_;
  GgxLobe lobe_;
  Rgb color_;
  Vec2 alpha_;
};

class GlossyMaterial final : public Material {
 public:
  explicit GlossyMaterial(const GlossyParameters& p) : p_(p) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    return arena.make<PreparedGlossy>(p_, wv, site, options.filter);
  }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  const GlossyParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters) {
  return std::make_shared<GlossyMaterial>(parameters);
}

}  // namespace velour
