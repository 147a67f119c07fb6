// For which scenes a model was reduced, and what that cost.
#pragma once

#include <cstdint>

#include "domain/scene_domain.h"

namespace velour {

/// Errors are those of fit/picture_error.h at the observed hits, against the measurement.
struct SceneRecord {
  SceneDomain domain;
  double picture_error = 0;       // relmse of this model
  double full_picture_error = 0;  // of the full model that it stands in for
  uint64_t full_parameter_bytes = 0;
};

}  // namespace velour
