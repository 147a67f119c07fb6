// Fits the parametric model to a measurement.
#pragma once

#include "fit/fit_options.h"
#include "job/progress.h"

namespace velour {

/// Few lobes for all views together, each in light or half space, followed over the views (brdf/parametric_brdf.h).
/// Grown lobe by lobe until every view is within the tolerance, the bounds are met, or one more gains next to nothing.
/// Isotropic measurements are fitted by a model that is symmetric about the plane of incidence. Deterministic for any
/// thread count.
Model fit_parametric(const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
