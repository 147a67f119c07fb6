// At which view angles a measurement has something to say.
#pragma once

#include <array>

#include "brdf/measurement.h"

namespace velour {

class ViewCoverage {
 public:
  ViewCoverage() = default;
  /// Asks `measurement` at every whole degree (0..89, azimuth 0) for a few hundred equal-area light directions: the
  /// view is covered where at least half of them are.
  explicit ViewCoverage(const Measurement& measurement);

  /// `theta_v` in radians; the nearest whole degree decides. False at and below the horizon.
  bool covers(float theta_v) const;

 private:
  std::array<bool, 90> covered_{};
};

}  // namespace velour
