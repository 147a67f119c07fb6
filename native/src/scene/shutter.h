// Times of camera rays.
#pragma once

#include <vector>

namespace velour {

/// Distribution of times over [0, 1], while the shutter is open: in proportion to how far it is open.
class Shutter {
 public:
  /// `opening`: at even times from 0 to 1, linear in between; a single value: constant. Throws Error(invalid_argument)
  /// unless all values are finite and at least 0, and one is above 0.
  explicit Shutter(const std::vector<float>& opening = {1.0f});

  /// Inverse of the distribution function; `u` in [0, 1).
  float time(float u) const;
  /// Density of time().
  float density(float time) const;

 private:
  std::vector<float> density_;  // at even times; at least two
  std::vector<float> below_;    // distribution function there
};

}  // namespace velour
