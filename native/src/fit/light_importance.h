// From which directions scenes light a material.
#pragma once

#include <vector>

#include "domain/observation.h"

namespace velour {

/// The mean radiance that observed hits receive by direction, relative to its mean over the hemisphere and kept within
/// 0.1 and 10, so that no direction is left out of a fit. Isotropic: by the angle to the view's azimuth.
class LightImportance {
 public:
  LightImportance(const SceneObservation& observation, bool isotropic);

  double operator()(const Vec3& wv, const Vec3& wl) const { return value_[bin(wv, wl)]; }

 private:
  static constexpr int kRings = 8, kSpokes = 12;  // rings of equal solid angle
  size_t bin(const Vec3& wv, const Vec3& wl) const;

  bool isotropic_;
  std::vector<double> value_;
};

}  // namespace velour
