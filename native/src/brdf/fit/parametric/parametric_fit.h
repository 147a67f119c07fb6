// Fits the parametric model to a measurement.
#pragma once

#include "base/progress.h"
#include "brdf/fit/fit_model.h"
#include "brdf/fit/parametric/growth.h"
#include "brdf/fit/slice_sampling.h"

namespace velour {

/// Fits a few lobes to all views together, each in light or half space and varying with the view
/// (brdf/model/parametric_brdf.h). Adds lobes until every view is within the tolerance, a bound is reached, or another
/// lobe gains next to nothing. Isotropic measurements are fitted by a model that is symmetric about the plane of
/// incidence. Deterministic for any thread count. `share`: the fit's share of the task's progress.
Model fit_parametric(const Measurement& measurement, const FitOptions& options, Progress& progress, double share = 1);

/// Continues the fit of an isotropic table that ended with the model `coarse`: with splines twice as fine, and up to 20
/// lobes or options.max_lobes.
Model fit_finer(const Measurement& measurement, const ParametricBrdf& coarse, const FitOptions& options,
                Progress& progress);

// The steps of fit_parametric(), for fits to a part of the views.

/// The slices that a parametric fit reads.
MeasuredSlices parametric_slices(const Measurement& measurement, const FitOptions& options, Progress& progress);
/// Options of the fit to all views.
GrowthOptions growth_options_of(const Measurement& measurement, const FitOptions& options);
/// The model of `fit` with its record, except for the time and the warnings about slices.
Model parametric_model(const Measurement& measurement, const GrowthResult& fit, const FitOptions& options,
                       Progress& progress);

}  // namespace velour
