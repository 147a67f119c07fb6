// Intersection of view rays with the structure over the reference plane.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/measure/relief_march.h"
#include "image/bilinear_texels.h"
#include "math/sphere/vec.h"

namespace velour {

/// Periodic height field over the tile, bilinear between texel centers. A view sees at a texel the first point that its
/// ray hits, so appearance stored at hit points varies little between views (relief mapping [POC05]).
class Relief {
 public:
  /// `heights`: [row][column], over the reference plane, in tile widths (extent along x). `aspect`: the tile's extent
  /// along y in the same unit.
  Relief(uint32_t width, uint32_t height, const std::vector<float>& heights, float aspect);

  /// First intersection, coming from outside, of the relief with the ray through `place` towards unit `wv` (wv.z > 0).
  /// `place`: on the reference plane, in tiles (x, y in [0, 1) repeat). Returns the hit point projected onto the plane,
  /// in tiles, not wrapped. Continuous in both arguments where the relief does not occlude itself.
  Vec2 seen(const Vec2& place, const Vec3& wv) const;
  /// seen() in texels from the center of the first one.
  Vec2 seen_texel(const Vec2& place, const Vec3& wv) const;

  /// (-dz/dx, -dz/dy) at a texel center by central differences, at most kSteepest long; the normal is along (x, y, 1).
  Vec2 slope(uint32_t x, uint32_t y) const;
  /// Bilinear slope between texels.
  Vec2 slope(const BilinearTexels& texels) const;
  static constexpr float kSteepest = 3.0f;

  uint32_t width() const { return width_; }
  uint32_t height() const { return rows_; }
  /// Height at a texel center.
  float height_of(uint32_t x, uint32_t y) const { return heights_[size_t{y} * width() + x]; }
  /// [row][column].
  const std::vector<float>& heights() const { return heights_; }
  bool flat() const { return top_ == bottom_; }

 private:
  uint32_t width_, rows_;
  std::vector<float> heights_;
  float aspect_, bottom_, top_;
  HeightWords words_;  // searched by seen()
};

}  // namespace velour
