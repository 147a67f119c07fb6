// From which directions scenes light a material.
#pragma once

#include <vector>

#include "domain/observation.h"

namespace velour {

/// The mean radiance that observed hits receive by direction, relative to its mean over the hemisphere and kept within
/// 0.1 and 10, so that no direction is left out of a fit. By the polar angle and by the angle to the view's azimuth, as
/// isotropic materials see it.
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
