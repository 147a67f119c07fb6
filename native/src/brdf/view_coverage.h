// View angles that a measurement covers.
#pragma once

#include <array>

#include "brdf/measurement.h"

namespace velour {

class ViewCoverage {
 public:
  ViewCoverage() = default;
  /// Evaluates `measurement` at every integer degree (0..89, azimuth 0) for a few hundred equal-area light directions;
  /// a view is covered if at least half of them are.
  explicit ViewCoverage(const Measurement& measurement);

  /// `theta_v` in radians; the nearest whole degree decides. False at and below the horizon.
  bool covers(float theta_v) const;

 private:
  std::array<bool, 90> covered_{};
};

}  // namespace velour
