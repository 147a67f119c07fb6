// Fits the parametric model to a measurement.
#pragma once

#include "fit/fit_options.h"
#include "fit/slice_sampling.h"
#include "fit/tracked_fit.h"
#include "job/progress.h"

namespace velour {

/// Few lobes for all views together, each in light or half space, followed over the views (brdf/parametric_brdf.h).
/// Grown lobe by lobe until every view is within the tolerance, the bounds are met, or one more gains next to nothing.
/// Isotropic measurements are fitted by a model that is symmetric about the plane of incidence. Deterministic for any
/// thread count. `share`: how much of the task's progress the fit is.
Model fit_parametric(const Measurement& measurement, const FitOptions& options, Progress& progress, double share = 1);

// The steps of it, for fits to a part of the views.

/// The slices that a parametric fit reads.
MeasuredSlices parametric_slices(const Measurement& measurement, const FitOptions& options, Progress& progress);
/// Of the fit to all views.
TrackedFitOptions tracked_options(const Measurement& measurement, const FitOptions& options);
/// The model of `fit` with its record, but for warnings of slices and the time.
Model parametric_model(const Measurement& measurement, const TrackedFit& fit, const FitOptions& options,
                       Progress& progress);

}  // namespace velour
