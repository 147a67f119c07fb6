// First steps of every fit of a measurement: check of the options, sampling of slices, warnings.
#pragma once

#include "fit/fit_options.h"
#include "fit/slice_sampling.h"
#include "job/progress.h"

namespace velour {

/// Throws Error(invalid_argument), naming the option, its value and the valid range.
void check_options(const FitOptions& options, int most_lobes);

/// The slices that the fit may read. Irregular samples are held out one by one, inside the measurement; tables by view
/// and light. A folded grid adds the irregular samples themselves (fit/sample_bins.h). Throws Error(bad_data) if there
/// is nothing to fit.
MeasuredSlices read_slices(const Measurement& measurement, const SliceGrid& grid, const FitOptions& options,
                           Progress& progress);

/// Appends a warning for views that are not covered, and one for colors outside the gamut.
void warn_of_slices(const MeasuredSlices& slices, std::vector<std::string>& warnings);

}  // namespace velour
