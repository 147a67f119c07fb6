#include "material/rough_diffuse_material.h"

#include <algorithm>
#include <cmath>

#include "math/sphere/warp.h"

namespace velour {
namespace {

constexpr float kWhole = 0.5f * kPi - 2.0f / 3;  // uneven_albedo at the horizon

/// Integral over the hemisphere of light of s / t (see the header) times the cosine.
float uneven_albedo(float cosine) {
  if (cosine < 1e-6f) return kWhole - cosine;
  const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
  return sine * (std::acos(std::min(cosine, 1.0f)) - 2.0f / 3 - sine * cosine) +
         2.0f / 3 * (sine / cosine) * (1 - sine * sine * sine);
}
constexpr float kMeanUnevenAlbedo = (2 * kPi - 5.6f) / 3;  // cosine-weighted

class PreparedRoughDiffuse final : public PreparedBrdf {
 public:
  PreparedRoughDiffuse(const RoughDiffuseParameters& p, const Vec3& wv, const SurfaceSite& site)
      : wv_(wv), color_(glm::clamp(p.color_texture.at(site, p.color), Rgb(0.0f), Rgb(1.0f))) {
    const float roughness = std::clamp(p.roughness_texture.at(site, p.roughness), 0.0f, 1.0f);
    even_ = 1 / (kPi + kWhole * roughness);
    uneven_ = roughness * even_;
    many_ = p.interreflection && roughness > 0 ? interreflected() : Rgb(0.0f);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    const bool any = many_ != Rgb(0.0f);
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i);
      float s = wv_.x * l.x + wv_.y * l.y;
      if (s > 0) s /= std::max(wv_.z, l.z);
      Rgb value = color_ * (even_ + uneven_ * s);
      if (any) value += many_ * one_minus_albedo(uneven_albedo(l.z));
      f.set(i, l.z > 0 ? value : Rgb(0.0f));
      pdf.v[i] = std::max(l.z, 0.0f) / kPi;
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { wl.fill(u, sample_cosine_hemisphere); }

 private:
  /// 1 - E of a white surface. A pi + B (pi/2 - 2/3) is 1, so a nearly smooth surface causes no cancellation.
  float one_minus_albedo(float uneven) const { return uneven_ * (kWhole - uneven); }

  /// Factor of the interreflection lobe that does not depend on the light.
  Rgb interreflected() const {
    const float lost = one_minus_albedo(kMeanUnevenAlbedo);                                // 1 - m
    const float of_mean = (kWhole - uneven_albedo(wv_.z)) / (kWhole - kMeanUnevenAlbedo);  // (1 - E) / (1 - m)
    return color_ * color_ * color_ * ((1 - lost) * of_mean / kPi) / (1.0f - color_ * lost);
  }

  Vec3 wv_;
  Rgb color_, many_;
  float even_, uneven_;  // A and B of the header
};

class RoughDiffuseMaterial final : public Material {
 public:
  explicit RoughDiffuseMaterial(const RoughDiffuseParameters& p) : p_(p) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<PreparedRoughDiffuse>(p_, wv, site);
  }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  const RoughDiffuseParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_rough_diffuse_material(const RoughDiffuseParameters& parameters) {
  return std::make_shared<RoughDiffuseMaterial>(parameters);
}

}  // namespace velour
