// Limits the directional albedo of a parametric model to 1.
#pragma once

#include "brdf/parametric_brdf.h"
#include "job/progress.h"

namespace velour {

/// Lowers the coefficients of `brdf` until no channel of its directional albedo exceeds 1, tested at views half a
/// degree apart. f does not change at views beyond the spline support of those that exceed 1. Control values stay half
/// floats. Returns whether anything changed.
bool limit_albedo(ParametricBrdf& brdf, int threads, const Progress& progress);

}  // namespace velour
