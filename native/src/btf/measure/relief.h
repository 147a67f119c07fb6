// A height field on which a BTF's texels lie, and rays that meet it.
#pragma once

#include <cstdint>
#include <vector>
#include "image/texels.h"
#include "math/sphere/vec.h"

namespace velour {

// Inner loop of relief intersection.

/// Period of a grid along an axis, in cells.
struct Period {
  explicit Period(uint32_t cells) : extent(static_cast<float>(cells)), inverse(1 / extent) {}
  float extent, inverse;
};

inline constexpr int kHeightRange = 1023;

/// Heights at the corners of a periodic grid, in 1023rds of their range, packed so that a grid line needs one word.
struct HeightWords {
  /// `part`: heights as fractions of their range, [row][column] in [0, 1].
  HeightWords(uint32_t width, uint32_t height, const std::vector<float>& part);

  Period columns, rows;
  uint32_t stride;  // width + 1
  /// [height + 1][stride]; the first row and column are repeated after the last ones. From the lowest bit: the height,
  /// that of the next column, and that of the next row, ten bits each.
  std::vector<uint32_t> word;

  /// For blocks of kBlock x kBlock cells, [row][column]: the maximum height within kBlock cells of the block.
  static constexpr uint32_t kBlock = 4;
  uint32_t blocks;  // per row
  std::vector<float> lid;
};

/// A ray over the grid, in cells from corner (0, 0). At time `when` in [0, 1] it is over from + when way, at height
/// 1023 (1 - when).
struct ReliefMarch {
  Vec2 from, way;
  bool high;  // rays over the surface are long, so HeightWords::lid is checked first
};

/// The point where the ray is first not above the surface, at the latest its end. The ray is tested at the grid lines
/// it crosses, where the surface is linear between corners, and interpolated linearly between crossings. Rays that
/// cross more than 1024 columns or rows are tested at 1024 lines at most. Run-time dispatched SIMD.
Vec2 first_meeting(const HeightWords& heights, const ReliefMarch& march);

// Intersection of view rays with the structure over the reference plane.

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
