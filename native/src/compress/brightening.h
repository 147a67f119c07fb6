// Brightness correction of fitted models.
#pragma once

#include <cmath>

#include "btf/factored_btf.h"

namespace velour {

/// Factor for a level's coefficients that restores the measured brightness. A least-squares fit of roots leaves out
/// their spread around the fit; f is their square, so its mean falls by the mean square of the residual, and the
/// material would be darker than measured. `measured`: the sum of squares of a level's roots over texels, channels and
/// pairs, each times cos(theta_l) cos(theta_v); `modelled`: the same of their fit. The factor preserves the light that
/// leaves the plane under uniform illumination.
inline float brightening(Companding companding, double measured, double modelled) {
  if (companding == Companding::none || !(modelled > 0)) return 1.0f;
  return static_cast<float>(std::sqrt(measured / modelled));
}

}  // namespace velour
