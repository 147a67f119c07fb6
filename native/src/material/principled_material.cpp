#include "material/principled_material.h"

#include <algorithm>

#include "material/ggx.h"
#include "material/specular_albedo.h"
#include "sphere/warp.h"

namespace velour {

namespace {

/// A metal, and a dielectric coat over a diffuse base, blended by `metallic`.
///
/// The base receives what the coat lets through: base / pi (1 - E(wv)) (1 - E(wl)) / (1 - E_mean), with E the coat's
/// albedo (Kelemen & Szirmay-Kalos 2001, Sec. 2.2). It is reciprocal, and a white base under any coat reflects exactly
/// all light, so no parameters reflect more than they receive.
class PrincipledMaterial final : public Material {
 public:
  explicit PrincipledMaterial(const PrincipledParameters& p)
      : base_color_(glm::clamp(p.base_color, Rgb(0), Rgb(1))),
        metallic_(std::clamp(p.metallic, 0.0f, 1.0f)),
        alpha_(std::clamp(p.roughness * p.roughness, kMinGgxAlpha, 1.0f)),
        eta_(index_of(p.specular)),
        coat_(alpha_, [this](float cosine) { return dielectric_fresnel(cosine, eta_); }),
        specular_(alpha_, [this](float cosine) { return luminance(fresnel(cosine)); }) {}

  void prepare(const Vec3& wv, PreparedBrdf& point) const override {
    point.wv = wv;
    const float through = (1 - metallic_) * (1 - coat_.at(wv.z));
    const float diffuse = luminance(base_color_) * through, specular = specular_.at(wv.z);
    point.parameter[kDiffuseScale] = through / (kPi * (1 - coat_.mean()));
    point.parameter[kDiffuseProbability] = diffuse + specular > 0 ? diffuse / (diffuse + specular) : 1;
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      const DirectionPair w{wl.get(i), point.wv};
      const Vec3 sum = w.wl + w.wv;
      const float length_sq = glm::dot(sum, sum);
      const Vec3 h = length_sq > 0 ? sum / std::sqrt(length_sq) : Vec3(0);  // opposed directions: no facet mirrors them
      f.set(i, w.wl.z > 0 ? diffuse(point, w.wl) + specular(w, h) : Rgb(0));
      const float share = point.parameter[kDiffuseProbability];
      pdf.v[i] = share * pdf_cosine_hemisphere(w.wl) + (1 - share) * pdf_ggx_reflection(w.wv, h, alpha_);
    }
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return sample_one(point, v); });
  }

  bool isotropic() const override { return true; }

 private:
  Vec3 sample_one(const PreparedBrdf& point, const Vec2& u) const {
    const float share = point.parameter[kDiffuseProbability];
    if (u.x < share) return sample_cosine_hemisphere({u.x / share, u.y});
    const float rest = std::min((u.x - share) / (1 - share), 1 - 0x1p-24f);
    const Vec3 h = sample_ggx_visible_normal(point.wv, alpha_, {rest, u.y});
    return 2 * glm::dot(point.wv, h) * h - point.wv;
  }

  enum Parameter { kDiffuseScale, kDiffuseProbability };

  /// Blender's scale: specular 0.5 is 4 % at normal incidence, an index of 1.5.
  static float index_of(float specular) {
    const float root = std::sqrt(std::clamp(0.08f * specular, 0.0f, 0.9f));
    return (1 + root) / (1 - root);
  }

  Rgb fresnel(float cosine) const {
    return metallic_ * schlick_fresnel(base_color_, cosine) + Rgb((1 - metallic_) * dielectric_fresnel(cosine, eta_));
  }

  Rgb diffuse(const PreparedBrdf& point, const Vec3& wl) const {
    return point.parameter[kDiffuseScale] * (1 - coat_.at(wl.z)) * base_color_;
  }

  Rgb specular(const DirectionPair& w, const Vec3& h) const {
    const float cosine = std::clamp(glm::dot(w.wv, h), 0.0f, 1.0f);
    return ggx_brdf_without_fresnel(w, h, alpha_) * fresnel(cosine);
  }

  Rgb base_color_;
  float metallic_;
  Vec2 alpha_;
  float eta_;
  SpecularAlbedo coat_, specular_;
};

}  // namespace

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters) {
  return std::make_shared<PrincipledMaterial>(parameters);
}

}  // namespace velour
