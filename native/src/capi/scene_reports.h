// JSON about what scenes show of materials, and about models reduced to it.
#pragma once

#include "capi/json_text.h"
#include "domain/observation.h"
#include "domain/surface_domain.h"
#include "model/scene_record.h"

namespace velour::capi {

/// Of a model that was reduced to what scenes need.
Json reduced_json(const SceneRecord& scene);

/// Of a material that varies over its surface.
Json surface_json(const SurfaceDomain& surface);

std::string observation_json(const SceneObservation& observation);
/// The same of the job that made it, which took `seconds`.
std::string observe_json(const SceneObservation& observation, double seconds);

}  // namespace velour::capi
