#include "realtime/ggx_lobes.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr double kSharpness[GgxLobes::kLobes] = {0.0127, 0.0885, 0.5195, 2.2067};
constexpr double kWeight[GgxLobes::kLobes] = {0.0003, 0.0132, 0.2604, 0.7058};

PrincipledParameters base_of(PrincipledParameters p) {
  p.part = PrincipledPart::base;
  return p;
}

Vec3d value(const PrincipledMaterial& material, const Vec3d& wl, const Vec3d& wv) {
  PreparedBrdf point;
  material.prepare(Vec3(wv), SurfaceSite::everywhere(), point);
  return Vec3d(material.eval_one(point, Vec3(wl)).f);
}

Vec3 view_at(double cosine) { return Vec3(Vec3d(std::sqrt(std::max(1 - cosine * cosine, 0.0)), 0, cosine)); }

double tangent_squared(double cosine) { return 1 / std::max(cosine * cosine, 1e-6) - 1; }

}  // namespace

GgxLobes::GgxLobes(const PrincipledParameters& p)
    : parameters_(p),
      alpha_(std::max(static_cast<double>(p.roughness * p.roughness), 0.01)),
      whole_(p),
      base_(base_of(p)) {}

std::vector<WarpedLobe> GgxLobes::lobes(const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02), square = alpha_ * alpha_;
  const Vec3d reflectance(PrincipledPoint(parameters_, view_at(cosine)).reflectance(static_cast<float>(cosine)));
  std::vector<WarpedLobe> lobes;
  for (int i = 0; i < kLobes; ++i) {
    WarpedLobe lobe;
    lobe.space = LobeSpace::half;
    lobe.bandwidth = 2 * kSharpness[i] / square;
    lobe.coefficient = kWeight[i] * masking(cosine, cosine) / (4 * kPiD * square * cosine) * reflectance;
    lobes.push_back(lobe);
  }
  return lobes;
}

Vec3d GgxLobes::growth(const Vec3d& wl, const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02);
  const PrincipledPoint point(parameters_, view_at(cosine));
  const auto at_facet = static_cast<float>(std::clamp(glm::dot(wl, glm::normalize(wl + wv)), 0.0, 1.0));
  // Without reflectance at normal incidence the ratio is 0, like the lobes.
  return masking(wl.z, cosine) / masking(cosine, cosine) * Vec3d(point.reflectance(at_facet)) /
         glm::max(Vec3d(point.reflectance(static_cast<float>(cosine))), Vec3d(1e-9));
}

Vec3d GgxLobes::base(const Vec3d& wl, const Vec3d& wv) const { return value(base_, wl, wv); }

Vec3d GgxLobes::f(const Vec3d& wl, const Vec3d& wv) const { return value(whole_, wl, wv); }

double GgxLobes::masking(double first, double second) const {
  const auto lambda = [&](double cosine) { return (std::sqrt(1 + alpha_ * alpha_ * tangent_squared(cosine)) - 1) / 2; };
  if (parameters_.lobe == GgxLobe::separable) return 1 / ((1 + lambda(first)) * (1 + lambda(second)));
  return 1 / (1 + lambda(first) + lambda(second));
}

}  // namespace velour
