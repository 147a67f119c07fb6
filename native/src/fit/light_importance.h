// Distribution of incident light over directions, from scene usage.
#pragma once

#include <vector>

#include "domain/observation.h"

namespace velour {

/// Mean incident radiance of the observed hits by direction, relative to its mean over the hemisphere and clamped to
/// 0.1..10, so that no direction is left out of a fit. Binned by polar angle and by azimuth relative to the view, which
/// suffices for isotropic materials.
class LightImportance {
 public:
  explicit LightImportance(const SceneObservation& observation);

  double operator()(const Vec3& wv, const Vec3& wl) const { return value_[bin(wv, wl)]; }

 private:
  static constexpr int kRings = 8, kSpokes = 12;  // rings of equal solid angle
  static size_t bin(const Vec3& wv, const Vec3& wl);

  std::vector<double> value_;
};

}  // namespace velour
