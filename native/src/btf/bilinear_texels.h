// The four texels about a place of a tile that repeats.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "sphere/vec.h"

namespace velour {

struct BilinearTexels {
  std::array<uint32_t, 4> index;  // row by row
  std::array<float, 4> weight;    // sum 1
};

/// `place` in tiles, of any size.
inline BilinearTexels bilinear_texels(const Vec2& place, uint32_t width, uint32_t height) {
  const Vec2 texel = (place - glm::floor(place)) * Vec2(width, height) - 0.5f, low = glm::floor(texel);
  const Vec2 part = texel - low;
  // From -1 to the size: rounding may give the whole tile.
  const auto wrapped = [](int i, uint32_t size) {
    const int n = static_cast<int>(size);
    return static_cast<uint32_t>(i < 0 ? i + n : (i >= n ? i - n : i));
  };
  BilinearTexels texels;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const auto i = static_cast<size_t>(corner);
    texels.index[i] =
        wrapped(static_cast<int>(low.y) + dy, height) * width + wrapped(static_cast<int>(low.x) + dx, width);
    texels.weight[i] = (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y);
  }
  return texels;
}

}  // namespace velour
