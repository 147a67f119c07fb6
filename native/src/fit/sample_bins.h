// Scattered samples as slices: the fit of the parametric model reads the samples themselves, not what lies between.
#pragma once

#include <span>
#include <vector>

#include "brdf/measurement.h"
#include "fit/slice_sampling.h"

namespace velour {

/// The samples of an isotropic measurement in bins of theta_v, each pair in both orders (f is taken as reciprocal, as
/// the interpolant takes it) and on one side of the plane of incidence. A pair comes to its bin's view with its half
/// vector kept: of all that the few tenths of a degree change, f feels that most. Every sample weighs the same. Bins
/// carry the energy of all samples within kHeldOutGroup, as the errors that are reported do.
std::vector<MeasuredSlice> bin_samples(std::span<const ScatteredSample> samples);

}  // namespace velour
