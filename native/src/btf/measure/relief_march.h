// Inner loop of relief intersection.
#pragma once

#include <cstdint>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

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

}  // namespace velour
