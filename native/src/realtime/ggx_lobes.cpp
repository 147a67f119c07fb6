#include "realtime/ggx_lobes.h"

#include <algorithm>
#include <cmath>

#include "material/principled_material.h"

namespace velour {
namespace {

constexpr double kSharpness[GgxLobes::kLobes] = {0.0127, 0.0885, 0.5195, 2.2067};
constexpr double kWeight[GgxLobes::kLobes] = {0.0003, 0.0132, 0.2604, 0.7058};

Vec3d value(const Material& material, const Vec3d& wl, const Vec3d& wv) {
  PreparedBrdf point;
  material.prepare(Vec3(wv), point);
  const Rgb f = material.eval_one(point, Vec3(wl)).f;
  return {f.r, f.g, f.b};
}

double tangent_squared(double cosine) { return 1 / std::max(cosine * cosine, 1e-6) - 1; }

}  // namespace

GgxLobes::GgxLobes(const PrincipledParameters& p)
    : alpha_(std::max(static_cast<double>(p.roughness * p.roughness), 0.01)),
      at_normal_(glm::mix(Vec3d(0.08 * static_cast<double>(p.specular)),
                          Vec3d(p.base_color.r, p.base_color.g, p.base_color.b), static_cast<double>(p.metallic))) {
  whole_ = make_principled_material(p);
  if (p.metallic >= 1) return;
  PrincipledParameters dull = p;
  dull.metallic = dull.specular = 0;
  dull.base_color *= 1 - p.metallic;
  base_ = make_principled_material(dull);
}

std::vector<WarpedLobe> GgxLobes::lobes(const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02), square = alpha_ * alpha_;
  std::vector<WarpedLobe> lobes;
  for (int i = 0; i < kLobes; ++i) {
    WarpedLobe lobe;
    lobe.space = LobeSpace::half;
    lobe.bandwidth = 2 * kSharpness[i] / square;
    lobe.coefficient = kWeight[i] * masking(cosine, cosine) / (4 * kPiD * square * cosine) * fresnel(cosine);
    lobes.push_back(lobe);
  }
  return lobes;
}

Vec3d GgxLobes::growth(const Vec3d& wl, const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02);
  // Without a reflectance at the normal it is 0 there, as the lobes are.
  return masking(wl.z, cosine) / masking(cosine, cosine) * fresnel(glm::dot(wl, glm::normalize(wl + wv))) /
         glm::max(fresnel(cosine), Vec3d(1e-9));
}

Vec3d GgxLobes::base(const Vec3d& wl, const Vec3d& wv) const { return base_ ? value(*base_, wl, wv) : Vec3d(0.0); }

Vec3d GgxLobes::f(const Vec3d& wl, const Vec3d& wv) const { return value(*whole_, wl, wv); }

Vec3d GgxLobes::fresnel(double cosine) const {
  return at_normal_ + (1.0 - at_normal_) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

double GgxLobes::masking(double first, double second) const {
  const auto lambda = [&](double cosine) { return (std::sqrt(1 + alpha_ * alpha_ * tangent_squared(cosine)) - 1) / 2; };
  return 1 / (1 + lambda(first) + lambda(second));
}

}  // namespace velour
