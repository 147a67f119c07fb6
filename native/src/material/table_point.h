// What a view sets up to draw from tables.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// How the tables divide the sphere about an axis: rows of d = 1 - cos of the angle to it, between 2 (k / kRows)^4, and
/// even columns of the azimuth's distance along the square |x| + |y| = 1.
struct TableGrid {
  static constexpr int kColumnBits = 5;
  static constexpr int kRows = 64, kColumns = 1 << kColumnBits;  // multiples of 16
  static constexpr int kRowsPadded = kRows + 16;

  static constexpr float row_edge(int row) {
    const float s = static_cast<float>(row) / kRows;
    return 2 * (s * s) * (s * s);
  }
};

/// The tables of two or four nodes, their weights in the mixture, and the frame that they lie in.
struct TablePoint {
  const float* table[4];
  float weight[4];
  int count = 0;
  float mass;  // integral of the luminance of f cos, by the tables, and the defence
  Vec3 tangent, bitangent, axis;
};

}  // namespace velour
