// Validation of a BTF's tile size.
#pragma once

#include <cmath>

#include "sphere/vec.h"

namespace velour {

/// Whether both extents, in meters along x and y, are positive and finite.
inline bool is_tile_size(const Vec2& metres) {
  return metres.x > 0 && metres.y > 0 && std::isfinite(metres.x) && std::isfinite(metres.y);
}

}  // namespace velour
