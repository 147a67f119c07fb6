// Fits a scene model: a parametric model reduced to scene usage.
#pragma once

#include "fit/fit_options.h"
#include "job/progress.h"

namespace velour {

/// The smallest parametric model found whose pictures, for the scene usage options.for_scene, are no worse than those
/// of the full model. It has fewer lobes and cells over a range of views; its fit is weighted by the observed views and
/// light directions. The full model is options.full_model, or is fitted first. If nothing smaller is good enough, the
/// full model's lobes are returned. The model has a SceneRecord and is not valid beyond its views
/// (domain/out_of_domain.h).
///
/// Throws Error(invalid_argument) if nothing was observed or the full model is not parametric or is itself reduced, and
/// Error(unsupported) for anisotropic measurements, because scene usage does not record azimuths.
Model fit_for_scene(const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
