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

class RoughDiffuseMaterial final : public Material {
  enum Parameter { kRed, kGreen, kBlue, kEven, kUneven, kManyRed, kManyGreen, kManyBlue };

 public:
  explicit RoughDiffuseMaterial(const RoughDiffuseParameters& p) : p_(p) {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    const Rgb color = glm::clamp(p_.color_texture.at(site, p_.color), Rgb(0.0f), Rgb(1.0f));
    const float roughness = std::clamp(p_.roughness_texture.at(site, p_.roughness), 0.0f, 1.0f);
    point.wv = wv;
    for (int c = 0; c < 3; ++c) point.parameter[kRed + c] = color[c];
    point.parameter[kEven] = 1 / (kPi + kWhole * roughness);
    point.parameter[kUneven] = roughness * point.parameter[kEven];
    const Rgb many = p_.interreflection && roughness > 0 ? interreflected(point, color) : Rgb(0.0f);
    for (int c = 0; c < 3; ++c) point.parameter[kManyRed + c] = many[c];
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    const Rgb color(point.parameter[kRed], point.parameter[kGreen], point.parameter[kBlue]);
    const Rgb many(point.parameter[kManyRed], point.parameter[kManyGreen], point.parameter[kManyBlue]);
    const bool any = many != Rgb(0.0f);
    const Vec3& wv = point.wv;
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 l = wl.get(i);
      float s = wv.x * l.x + wv.y * l.y;
      if (s > 0) s /= std::max(wv.z, l.z);
      Rgb value = color * (point.parameter[kEven] + point.parameter[kUneven] * s);
      if (any) value += many * one_minus_albedo(point, uneven_albedo(l.z));
      f.set(i, l.z > 0 ? value : Rgb(0.0f));
      pdf.v[i] = std::max(l.z, 0.0f) / kPi;
    }
  }

  void sample(const PreparedBrdf& /*point*/, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, sample_cosine_hemisphere);
  }

  bool varies() const override { return p_.color_texture.given() || p_.roughness_texture.given(); }
  bool isotropic() const override { return true; }

 private:
  /// 1 - E of a white surface. A pi + B (pi/2 - 2/3) is 1, so a nearly smooth surface causes no cancellation.
  static float one_minus_albedo(const PreparedBrdf& point, float uneven) {
    return point.parameter[kUneven] * (kWhole - uneven);
  }

  /// Factor of the interreflection lobe that does not depend on the light.
  static Rgb interreflected(const PreparedBrdf& point, const Rgb& color) {
    const float lost = one_minus_albedo(point, kMeanUnevenAlbedo);                              // 1 - m
    const float of_mean = (kWhole - uneven_albedo(point.wv.z)) / (kWhole - kMeanUnevenAlbedo);  // (1 - E) / (1 - m)
    return color * color * color * ((1 - lost) * of_mean / kPi) / (1.0f - color * lost);
  }

  const RoughDiffuseParameters p_;
};

}  // namespace

std::shared_ptr<const Material> make_rough_diffuse_material(const RoughDiffuseParameters& parameters) {
  return std::make_shared<RoughDiffuseMaterial>(parameters);
}

}  // namespace velour
