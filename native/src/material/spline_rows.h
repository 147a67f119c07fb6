// The rows of a parametric model's coefficients that a view mixes.
#pragma once

#include "sphere/view_spline.h"

namespace velour {

inline constexpr float kLog2E = 1.44269504f;

/// ViewTaps with pointers to the coefficients, in float: what the SIMD kernel reads.
struct SplineRows {
  static constexpr int kIsotropicTaps = 3;
  const float* half;  // of the lobes
  int stride;         // from one parameter to the next, lobes
  float stretch;      // factor of the stretches: pole_fade
  const float* row[ViewTaps::kMost];
  float weight[ViewTaps::kMost], odd_weight[ViewTaps::kMost];
};

}  // namespace velour
