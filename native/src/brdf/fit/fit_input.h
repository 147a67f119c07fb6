// First steps of every fit of a measurement: check of the options, sampling of slices, warnings.
#pragma once

#include <span>
#include <vector>
#include "base/progress.h"
#include "base/warning.h"
#include "brdf/fit/fit_model.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/measure/measurement.h"

namespace velour {

/// Throws Error(invalid_argument), naming the option, its value and the valid range.
void check_options(const FitOptions& options, int most_lobes);

/// The slices that the fit may read. Irregular samples are held out one by one, inside the measurement; tables by view
/// and light. A folded grid adds the irregular samples themselves (brdf/fit/fit_input.h). Throws Error(bad_data) if
/// there is nothing to fit.
MeasuredSlices read_slices(const Measurement& measurement, const SliceGrid& grid, const FitOptions& options,
                           Progress& progress);

/// Appends a warning for views that are not covered, and one for colors outside the gamut.
void warn_of_slices(const MeasuredSlices& slices, std::vector<Warning>& warnings);

// Irregular samples as slices: the parametric fit reads the samples themselves, not only their interpolation.

/// The samples of an isotropic measurement in bins of theta_v, each pair in both orders (f is assumed reciprocal, as by
/// the interpolation) and on one side of the plane of incidence. A pair is moved to the view of its bin, by a few
/// tenths of a degree, with its half vector kept, because f depends on it most. All samples have the same weight. Bins
/// have the energy of all samples within kHeldOutGroup, as reported errors do.
std::vector<MeasuredSlice> bin_samples(std::span<const IrregularSample> samples);

}  // namespace velour
