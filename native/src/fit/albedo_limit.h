// No more light out of a model than goes in.
#pragma once

#include "brdf/parametric_brdf.h"
#include "job/progress.h"

namespace velour {

/// Lowers the coefficients of `brdf` until no channel of its directional albedo is above 1 at any view, views of half a
/// degree apart, and no further than that: where the albedo is below 1 by more than the reach of the splines, f stays
/// as it was. Control values stay half floats. True when anything was changed.
bool limit_albedo(ParametricBrdf& brdf, int threads, const Progress& progress);

}  // namespace velour
