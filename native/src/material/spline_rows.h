// The rows of a parametric model's coefficients that a view mixes.
#pragma once

#include "sphere/view_spline.h"

namespace velour {

/// ViewTaps with pointers to the coefficients, in float: what the SIMD kernel reads.
struct SplineRows {
  int count;
  int stride;     // from one parameter to the next, lobes
  float stretch;  // factor of the stretches: pole_fade
  const float* row[ViewTaps::kMost];
  float weight[ViewTaps::kMost], odd_weight[ViewTaps::kMost];
};

}  // namespace velour
