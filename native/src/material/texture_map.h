// Affine map of texture coordinates: places an image or a tile on a surface.
#pragma once

#include <cmath>

#include "sphere/vec.h"

namespace velour {

/// Maps (u, v) of a surface to `map` (u, v) + `shift`.
struct TextureMap {
  Mat2 map{1.0f};
  Vec2 shift{0.0f};

  Vec2 point(const Vec2& uv) const { return map * uv + shift; }
  /// A singular map leaves no direction for a tangent and no width for a footprint.
  bool invertible() const {
    const float sum = map[0].x + map[0].y + map[1].x + map[1].y + shift.x + shift.y;
    return std::isfinite(sum) && glm::determinant(glm::dmat2(map)) != 0.0;
  }
};

}  // namespace velour
