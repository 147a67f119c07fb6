// JSON reports on scene usage, and on scene models.
#pragma once

#include "capi/json_text.h"
#include "domain/observation.h"
#include "domain/surface_domain.h"
#include "model/scene_record.h"

namespace velour::capi {

/// Keys of a scene model.
Json reduced_json(const SceneRecord& scene);

/// Usage of a material that varies over its surface.
Json surface_json(const SurfaceDomain& surface);

std::string observation_json(const SceneObservation& observation);
/// Report of the job that made the observation, which took `seconds`.
std::string observe_json(const SceneObservation& observation, double seconds);

}  // namespace velour::capi
