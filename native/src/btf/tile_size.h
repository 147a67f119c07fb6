// What can be the size of a BTF's tile.
#pragma once

#include <cmath>

#include "sphere/vec.h"

namespace velour {

/// Metres along x and y: positive and finite.
inline bool is_tile_size(const Vec2& metres) {
  return metres.x > 0 && metres.y > 0 && std::isfinite(metres.x) && std::isfinite(metres.y);
}

}  // namespace velour
