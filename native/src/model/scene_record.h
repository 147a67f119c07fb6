// Scene usage that a model was reduced to, and the resulting errors.
#pragma once

#include <array>
#include <cstdint>

#include "domain/scene_domain.h"

namespace velour {

/// Errors are relmse at the observed hits, against the measurement (fit/picture_error.h, compress/seen_pictures.h).
struct SceneRecord {
  SceneDomain domain;
  double picture_error = 0;       // relmse of this model
  double full_picture_error = 0;  // relmse of the full model
  uint64_t full_parameter_bytes = 0;
  /// For a BTF: texels along x and y at the full model's finest level. Levels finer than its own grid are dropped.
  std::array<uint32_t, 2> full_texels{};
  /// For a BTF: fitted only to the observed views and those around them, with errors. False: only levels were dropped,
  /// the model is valid for all views, and the errors are 0.
  bool seen_views_alone = false;
};

}  // namespace velour
