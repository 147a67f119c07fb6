// The inner loop of reliefs.
#pragma once

#include <cstdint>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Cells of a grid along an axis until it repeats.
struct Period {
  explicit Period(uint32_t cells) : extent(static_cast<float>(cells)), inverse(1 / extent) {}
  float extent, inverse;
};

inline constexpr int kHeightRange = 1023;

/// Heights at the corners of a grid that repeats, in 1023rds of their range: a line of the grid takes one word a place.
struct HeightWords {
  /// `part`: of the range, [row][column] in [0, 1].
  HeightWords(uint32_t width, uint32_t height, const std::vector<float>& part);

  Period columns, rows;
  uint32_t stride;  // width + 1
  /// [height + 1][stride], the first row and column again behind the last ones: from the lowest bit on the height, that
  /// of the next column, that of the next row, ten bits each.
  std::vector<uint32_t> word;

  /// Of squares of kBlock x kBlock cells, [row][column]: the greatest height within kBlock cells of the square.
  static constexpr uint32_t kBlock = 4;
  uint32_t blocks;  // of a row
  std::vector<float> lid;
};

/// A ray over the grid, in its cells from corner (0, 0): at `when` in [0, 1] it is over from + when way, at height
/// 1023 (1 - when).
struct ReliefMarch {
  Vec2 from, way;
  bool high;  // rays over the surface are long: it pays to look at HeightWords::lid first
};

/// Where the ray first is not above the surface, which is bilinear between corners: from line to line of the grid, and
/// exactly within the cell where that happens. Rays that cross more than 1024 columns or rows are looked at in as many
/// lines. At the end at the latest. Run-time dispatched SIMD.
Vec2 first_meeting(const HeightWords& heights, const ReliefMarch& march);

}  // namespace velour
