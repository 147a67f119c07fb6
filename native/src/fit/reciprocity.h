// How far a BRDF is from f(wl, wv) = f(wv, wl).
#pragma once

#include <optional>

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"

namespace velour {

/// Relative L2 of the difference of the luminances a = f(wl, wv) cos cos and b = f(wv, wl) cos cos over the square of
/// the hemisphere, sqrt(sum (a - b)^2 / sum (a^2 + b^2) / 2): 0 for a reciprocal f, the root of 2 where of every pair
/// one is black. Views: 16 of equal solid angle, on the meridian when isotropic; lights: half vectors about each
/// (fit/view_grid.h).
double reciprocity_error(const Material& material, const Progress& progress);

/// The same of the pairs that a measurement covers both ways; nothing when there are none, and for scattered samples,
/// whose interpolation takes reciprocity for granted.
std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress);

}  // namespace velour
