// Irregular samples as slices: the parametric fit reads the samples themselves, not only their interpolation.
#pragma once

#include <span>
#include <vector>

#include "brdf/measurement.h"
#include "fit/slice_sampling.h"

namespace velour {

/// The samples of an isotropic measurement in bins of theta_v, each pair in both orders (f is assumed reciprocal, as by
/// the interpolation) and on one side of the plane of incidence. A pair is moved to the view of its bin, by a few
/// tenths of a degree, with its half vector kept, because f depends on it most. All samples have the same weight. Bins
/// have the energy of all samples within kHeldOutGroup, as reported errors do.
std::vector<MeasuredSlice> bin_samples(std::span<const ScatteredSample> samples);

}  // namespace velour
