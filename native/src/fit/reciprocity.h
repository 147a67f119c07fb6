// Deviation of a BRDF from reciprocity, f(wl, wv) = f(wv, wl).
#pragma once

#include <optional>

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"

namespace velour {

/// Relative L2 of the difference of the luminances a = f(wl, wv) cos cos and b = f(wv, wl) cos cos over all pairs of
/// directions, sqrt(2 sum (a - b)^2 / sum (a^2 + b^2)): 0 if f is reciprocal, sqrt(2) if one of every pair is black.
/// Views: 16 of equal solid angle, on the meridian if isotropic. Lights: half vectors about each (fit/view_grid.h).
double reciprocity_error(const Material& material, const Progress& progress);

/// Reciprocity error over the pairs that a measurement covers both ways. Nothing if there are none, and for irregular
/// samples, whose interpolation assumes reciprocity.
std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress);

}  // namespace velour
