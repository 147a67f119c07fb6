#include "realtime/lobes_of_views.h"

#include <algorithm>

#include "realtime/exchanged_lobes.h"
#include "realtime/ggx_lobes.h"

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

}  // namespace velour
