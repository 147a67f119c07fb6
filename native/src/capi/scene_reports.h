// JSON reports on scene usage, and on scene models.
#pragma once

#include <string>
#include "capi/json_text.h"
#include "model/records.h"
#include "render/render.h"
#include "scene/scene.h"
#include "usage/observation.h"
#include "usage/scene_domain.h"

namespace velour::capi {

/// Keys of a scene model.
Json reduced_json(const SceneRecord& scene);

/// Usage of a material that varies over its surface.
Json surface_json(const SurfaceDomain& surface);

std::string observation_json(const SceneObservation& observation);
/// Report of the job that made the observation, which took `seconds`.
std::string observe_json(const SceneObservation& observation, double seconds);

// JSON reports on scenes and renders, with the keys of the command line's verbs (docs/reference/cli_render.md).

std::string scene_json(const Scene& scene);
std::string render_json(const RenderReport& report);

}  // namespace velour::capi
