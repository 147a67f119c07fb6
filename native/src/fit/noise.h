// Noise of a measurement, from pairs of values that are equal by physics.
#pragma once

#include <optional>

#include "brdf/measurement.h"
#include "job/progress.h"

namespace velour {

/// Relative noise of the luminance of f cos at one reported view (one of kHeldOutViews), in the units of relative_l2:
/// the RMS difference of paired values over sqrt(2), divided by their RMS. Pairs are mirror images about the plane of
/// incidence (isotropic only) and reciprocal directions. Returns the larger of the two estimates, because a table that
/// stores both members of a pair as one entry shows no noise there. Irregular samples: pairs of samples within one
/// degree of each other after either symmetry. Nothing if there are no pairs.
std::optional<double> noise_of_view(const Measurement& measurement, int degrees, const Progress& progress);

}  // namespace velour
