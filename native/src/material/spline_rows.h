// The rows of a parametric model's coefficients that a view mixes.
#pragma once

#include "sphere/view_spline.h"

namespace velour {

inline constexpr float kLog2E = 1.44269504f;

/// What the SIMD kernel reads: rows of [parameter][lobe], and how they are mixed.
struct SplineRows {
  static constexpr int kIsotropicTaps = 3;
  const float* half;     // of the lobes
  const float* control;  // the first row
  int stride;            // from one parameter to the next
  int row;               // from one row to the next
  float stretch;         // factor of the stretches: pole_fade
  ViewTapsOf<float> taps;
};

}  // namespace velour
