// Fits no more of a parametric model than scenes need.
#pragma once

#include "fit/fit_options.h"
#include "job/progress.h"

namespace velour {

/// The smallest parametric model found that, over the views at which options.for_scene saw the material, makes pictures
/// no worse than the full model does: fewer lobes and fewer cells over a range of views, weighted by how often views
/// were seen and from where light came. The full model is options.full_model, or is fitted first. Where nothing smaller
/// will do, the full model's lobes are returned. The model carries a SceneRecord; beyond its views it is not to be
/// trusted (domain/out_of_domain.h).
///
/// Throws Error(invalid_argument) when nothing was observed, or the full model is not parametric, and
/// Error(unsupported) for anisotropic measurements: a domain does not know azimuths.
Model fit_for_scene(const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
