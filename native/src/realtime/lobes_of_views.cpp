#include "realtime/lobes_of_views.h"

#include <algorithm>
#include <cmath>
#include "realtime/exchanged_lobes.h"

namespace velour {

namespace {

/// f of the chosen lobes.
Vec3d sum_of(const std::vector<WarpedLobe>& lobes, const std::vector<bool>& chosen, const Vec3d& wl, const Vec3d& wv) {
  Vec3d sum(0.0);
  for (size_t j = 0; j < lobes.size(); ++j) {
    if (chosen[j]) sum += lobes[j].coefficient * warped_kernel(lobes[j], wl, wv);
  }
  return sum;
}

class ParametricLobes : public LobesOfViews {
 public:
  explicit ParametricLobes(const ParametricBrdf& brdf) : brdf_(brdf) {}

  LobeOf of() const override { return LobeOf::f; }
  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    std::vector<ReachedLobe> lobes;
    for (const WarpedLobe& lobe : lobes_at(brdf_, wv)) lobes.push_back(reached(lobe, wv));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& /*lobes*/, size_t /*j*/, const Vec3d& /*wl*/,
               const Vec3d& /*wv*/) const override {
    return Vec3d(1.0);
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    return sum_of(lobes_at(brdf_, wv), soft, wl, wv);
  }

 protected:
  const ParametricBrdf& brdf_;
};

class SymmetricLobes final : public ParametricLobes {
 public:
  explicit SymmetricLobes(const ParametricBrdf& brdf) : ParametricLobes(brdf), exchanged_(brdf) {}

  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    auto lobes = ParametricLobes::lobes(wv);
    for (ReachedLobe& lobe : lobes) lobe.lobe.coefficient *= 0.5;
    for (int j = 0; j < brdf_.lobe_count(); ++j) lobes.push_back(exchanged_.at(j, wv).value_or(ReachedLobe()));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const override {
    if (j < own() || !lobes[j].reach.is_seen) return Vec3d(1.0);
    return Vec3d(exchanged_.growth(static_cast<int>(j - own()), lobes[j], wl, wv));
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    Vec3d sum = 0.5 * ParametricLobes::soft_value(soft, wl, wv);
    for (int j = 0; j < brdf_.lobe_count(); ++j) {
      if (soft[own() + static_cast<size_t>(j)]) sum += exchanged_.value(j, wl, wv);
    }
    return sum;
  }

 private:
  size_t own() const { return brdf_.space.size(); }

  ExchangedLobes exchanged_;
};

class HighlightLobes final : public LobesOfViews {
 public:
  explicit HighlightLobes(const PrincipledParameters& parameters) : ggx_(parameters) {}

  LobeOf of() const override { return LobeOf::f_cosine; }
  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    std::vector<ReachedLobe> lobes;
    for (const WarpedLobe& lobe : ggx_.lobes(wv)) lobes.push_back(reached(lobe, wv));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& /*lobes*/, size_t /*j*/, const Vec3d& wl,
               const Vec3d& wv) const override {
    return wl.z > 0 ? ggx_.growth(wl, wv) : Vec3d(1.0);
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    if (std::find(soft.begin(), soft.end(), false) == soft.end()) return ggx_.f(wl, wv);
    return ggx_.base(wl, wv) + ggx_.growth(wl, wv) * sum_of(ggx_.lobes(wv), soft, wl, wv) / wl.z;
  }

 private:
  GgxLobes ggx_;
};

}  // namespace

std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf) {
  if (brdf.symmetric) return std::make_unique<SymmetricLobes>(brdf);
  return std::make_unique<ParametricLobes>(brdf);
}

std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters) {
  return std::make_unique<HighlightLobes>(parameters);
}

namespace {

constexpr double kSharpness[GgxLobes::kLobes] = {0.0127, 0.0885, 0.5195, 2.2067};
constexpr double kWeight[GgxLobes::kLobes] = {0.0003, 0.0132, 0.2604, 0.7058};

PrincipledParameters base_of(PrincipledParameters p) {
  p.part = PrincipledPart::base;
  return p;
}

Vec3d value(const Material& material, const Vec3d& wl, const Vec3d& wv) {
  ScratchArena arena;
  return Vec3d(material.prepare(Vec3(wv), arena)->eval_one(Vec3(wl)).f);
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
