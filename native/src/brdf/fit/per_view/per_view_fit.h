// Fits the per-view univariate SRBF model to a measurement.
#pragma once

#include "base/progress.h"
#include "brdf/fit/options.h"
#include "brdf/fit/per_view/fitted_slices.h"
#include "model/records.h"

namespace velour {

/// Each view's slice of f cos(theta_l) is fitted by greedy insertion and joint refinement with non-negative
/// coefficients until the tolerance or the bound is reached. Deterministic for any thread count.
Model fit_per_view(const Measurement& measurement, const FitOptions& options, Progress& progress);

// The order curve of a per-view fit, from the greedy paths of its views, without refitting.

/// The points of `all` with at most 1, 2, 4, ... lobes per view, and that of `chosen`, the stored model. Errors are
/// those of the views at their own samples, without the interpolation between views.
OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance);

}  // namespace velour
