// A picture of a scene.
#pragma once

#include "job/progress.h"
#include "render/film.h"
#include "render/options.h"
#include "render/report.h"
#include "scene/scene.h"

namespace velour {

/// Renders a committed scene into `film` (cleared first), whose window is that of `options`. Throws
/// Error(invalid_argument) with the option at fault, Error(invalid_state) when the scene is not committed, and
/// Error(cancelled): then the film holds what was done.
///
/// The picture is a function of scene, options (less threads and camera_rays_per_pass) and seed, bit for bit. A crop
/// has the bits of the whole there; ranges of samples have its camera rays, and so add up to it within rounding.
RenderReport render(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress);

}  // namespace velour
