// Per-view state of table sampling.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Partition of the sphere about an axis: rows of d = 1 - cos of the angle to it, with edges at 2 (k / kRows)^4, and
/// columns of equal length along the square |x| + |y| = 1 in azimuth.
struct TableGrid {
  static constexpr int kColumnBits = 5;
  static constexpr int kRows = 64, kColumns = 1 << kColumnBits;  // multiples of 16
  static constexpr int kRowsPadded = kRows + 16;

  static constexpr float row_edge(int row) {
    const float s = static_cast<float>(row) / kRows;
    return 2 * (s * s) * (s * s);
  }
};

/// The tables of two or four nodes, their weights in the mixture, and their frame.
struct TablePoint {
  const float* table[4];
  float weight[4];
  int count = 0;
  float mass;  // integral of the tables: luminance of f cos and the defensive share
  Vec3 tangent, bitangent, axis;
};

}  // namespace velour
