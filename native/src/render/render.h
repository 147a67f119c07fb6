// Renders an image of a scene.
#pragma once

#include "job/progress.h"
#include "render/film.h"
#include "render/options.h"
#include "render/report.h"
#include "scene/scene.h"

namespace velour {

/// Renders a committed scene into `film`, whose window must be that of `options`; clears it first unless
/// options.onto_film. Throws Error(invalid_argument) naming the option at fault, Error(invalid_state) if the scene is
/// not committed, and Error(cancelled): then the film holds what was done.
///
/// The image is a function of scene, options (except threads and camera_rays_per_pass) and seed, bit for bit. A crop
/// has the same bits as the whole image there. Ranges of samples have the same camera rays as the whole, and so add up
/// to it within rounding.
RenderReport render(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress);

}  // namespace velour
