// Texels of a tile that are occluded in a view.
#pragma once

#include <vector>

#include "votf/eval/shell_field.h"

namespace velour {

/// Texels over one period of a tile, [row][column]; row 0 is at y = 0.
struct TileTexels {
  uint32_t width, height;
  float aspect;  // height / width of the tile

  size_t size() const { return size_t{width} * height; }
  /// Center of a texel, in tile widths.
  Vec2 center(uint32_t x, uint32_t y) const {
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(height) * aspect};
  }
  Vec2 center(size_t texel) const {
    return center(static_cast<uint32_t>(texel % width), static_cast<uint32_t>(texel / width));
  }
};

/// View `i` for validating a volume: uniform in solid angle up to 75 degrees.
Vec3 check_view(uint64_t seed, uint32_t i);

/// V at the texel centers for a view: 1 where the line through the center along `wv` meets the structure.
std::vector<uint8_t> visibility_mask(const ShellField& field, const TileTexels& texels, const Vec3& wv);

}  // namespace velour
