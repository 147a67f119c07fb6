// Models as bright as what they were fitted to.
#pragma once

#include <cmath>

#include "btf/factored_btf.h"

namespace velour {

/// What a level's coefficients are multiplied by. Least squares leave out how roots are spread about the fit; f is
/// their square, so its mean falls by the mean square of what is left out, and a material would be darker than
/// measured. `measured`: the sum of squares of a level's roots over texels, channels and pairs, each times
/// cos(theta_l) cos(theta_v); `modelled`: that of their fit. With the result the light that the plane sends on is the
/// same where it comes evenly.
inline float brightening(Companding companding, double measured, double modelled) {
  if (companding == Companding::none || !(modelled > 0)) return 1.0f;
  return static_cast<float>(std::sqrt(measured / modelled));
}

}  // namespace velour
