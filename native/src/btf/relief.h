// Where a view's ray meets the structure over the reference plane.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/bilinear_texels.h"
#include "btf/relief_march.h"
#include "sphere/vec.h"

namespace velour {

/// Heights over the tile, periodic, bilinear between the centres of texels: what a BTF's texels belong to. What a view
/// shows at a texel is what its ray meets first, so appearance that is kept where the ray ends changes little from view
/// to view (relief mapping [POC05]).
class Relief {
 public:
  /// `height`: [row][column], over the reference plane, in widths of the tile (its extent along x); `aspect`: the
  /// tile's extent along y in the same unit.
  Relief(uint32_t width, uint32_t height, const std::vector<float>& heights, float aspect);

  /// `place`: on the reference plane, in tiles (x, y in [0, 1) repeat). Where the ray through it towards unit `wv`
  /// (wv.z > 0) meets the relief first, coming from outside: the point below or above which it does, in tiles, not
  /// wrapped. Continuous in both arguments where the relief hides nothing of itself.
  Vec2 seen(const Vec2& place, const Vec3& wv) const;
  /// The same in texels, from the centre of the first one.
  Vec2 seen_texel(const Vec2& place, const Vec3& wv) const;

  /// (-dz/dx, -dz/dy) at the centre of a texel, over two texels: the normal is along (x, y, 1). Steeper than
  /// kSteepest is cut to that.
  Vec2 slope(uint32_t x, uint32_t y) const;
  /// The same between texels.
  Vec2 slope(const BilinearTexels& texels) const;
  static constexpr float kSteepest = 3.0f;

  uint32_t width() const { return width_; }
  uint32_t height() const { return rows_; }
  /// At the centre of a texel.
  float height_of(uint32_t x, uint32_t y) const { return heights_[size_t{y} * width() + x]; }
  /// [row][column].
  const std::vector<float>& heights() const { return heights_; }
  bool flat() const { return top_ == bottom_; }

 private:
  uint32_t width_, rows_;
  std::vector<float> heights_;
  float aspect_, bottom_, top_;
  HeightWords words_;  // what seen() looks at
};

}  // namespace velour
