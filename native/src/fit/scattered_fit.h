// Fits the per-view univariate SRBF model to a measurement.
#pragma once

#include "fit/fit_options.h"
#include "job/progress.h"

namespace velour {

/// Each view's slice of f cos(theta_l) is fitted by greedy insertion and joint refinement with non-negative
/// coefficients until the tolerance or the bound is reached. Deterministic for any thread count.
Model fit_scattered(const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
