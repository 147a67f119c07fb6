// The measurement's own noise, from pairs of values that physics makes equal.
#pragma once

#include <optional>

#include "brdf/measurement.h"
#include "job/progress.h"

namespace velour {

/// Relative noise of the luminance of f cos at one reported view (a key of kHeldOutViews), in the units of relative_l2:
/// the RMS difference of paired values over sqrt(2), over their RMS. Pairs are mirror images about the plane of
/// incidence (isotropic only) and reciprocal directions; the larger of the two estimates, because a table that shares
/// its entries between the members of a pair shows none there. Scattered samples: pairs of samples within one degree of
/// each other after either symmetry. Nothing when there are no pairs.
std::optional<double> noise_of_view(const Measurement& measurement, int degrees, const Progress& progress);

}  // namespace velour
