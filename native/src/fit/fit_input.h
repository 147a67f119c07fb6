// What every fit of a measurement begins with: options checked, slices sampled, and a word for what was left out.
#pragma once

#include "fit/fit_options.h"
#include "fit/slice_sampling.h"
#include "job/progress.h"

namespace velour {

/// Throws Error(invalid_argument) with the option, its value and what it may be.
void check_options(const FitOptions& options, int most_lobes);

/// The slices that the fit may read: scattered samples are held out one by one, inside the measurement; tables by view
/// and light. A folded grid adds scattered samples themselves (fit/sample_bins.h). Throws Error(bad_data) when there is
/// nothing to fit.
MeasuredSlices read_slices(const Measurement& measurement, const SliceGrid& grid, const FitOptions& options,
                           Progress& progress);

/// A sentence each for views that are not covered and for colours outside the gamut.
void warn_of_slices(const MeasuredSlices& slices, std::vector<std::string>& warnings);

}  // namespace velour
