// For which scenes a model was reduced, and what that cost.
#pragma once

#include <array>
#include <cstdint>

#include "domain/scene_domain.h"

namespace velour {

/// Errors are relmse at the observed hits, against the measurement (fit/picture_error.h, compress/seen_pictures.h).
struct SceneRecord {
  SceneDomain domain;
  double picture_error = 0;       // relmse of this model
  double full_picture_error = 0;  // of the full model that it stands in for
  uint64_t full_parameter_bytes = 0;
  /// Of a BTF: along x and y at the full model's finest level. The levels up to its own grid are left out.
  std::array<uint32_t, 2> full_texels{};
  /// Of a BTF: fitted to the views that were seen and those around them, with errors. Else levels were left out, no
  /// more: the model holds for all views, and the errors are 0.
  bool seen_views_alone = false;
};

}  // namespace velour
