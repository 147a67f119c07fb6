// Rows of a parametric model's coefficients that are mixed for a view.
#pragma once

#include "sphere/view_spline.h"

namespace velour {

inline constexpr float kLog2E = 1.44269504f;

/// Input of the SIMD kernel: rows of [parameter][lobe] and their weights.
struct SplineRows {
  static constexpr int kIsotropicTaps = 3;
  const float* half;     // 1 for half-vector lobes, else 0
  const float* control;  // the first row
  int stride;            // from one parameter to the next
  int row;               // from one row to the next
  float stretch;         // factor of the stretches: pole_fade
  ViewTapsOf<float> taps;
};

}  // namespace velour
