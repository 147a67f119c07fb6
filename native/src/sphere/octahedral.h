// Octahedral map of the sphere to a square grid of cells, for tables over directions.
#pragma once

#include <algorithm>

#include "sphere/vec.h"

namespace velour {

/// Octahedral map [ED08]: unit direction -> [0, 1]^2. Solid angles of cells of equal side differ by a factor below 3.4.
inline Vec2 octahedral_from(const Vec3& w) {
  const float scale = 1.0f / (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
  Vec2 p(w.x * scale, w.y * scale);
  if (w.z < 0) p = {std::copysign(1 - std::abs(p.y), w.x), std::copysign(1 - std::abs(p.x), w.y)};
  return 0.5f * p + 0.5f;
}

inline Vec3 octahedral_to(const Vec2& square) {
  const Vec2 p = 2.0f * square - 1.0f;
  Vec3 w(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
  if (w.z < 0) {
    w.x = std::copysign(1 - std::abs(p.y), p.x);
    w.y = std::copysign(1 - std::abs(p.x), p.y);
  }
  return glm::normalize(w);
}

/// Index in [0, side^2) of the cell that contains unit `w`.
inline int octahedral_cell(const Vec3& w, int side) {
  const Vec2 p = octahedral_from(w) * static_cast<float>(side);
  const int x = std::clamp(static_cast<int>(p.x), 0, side - 1), y = std::clamp(static_cast<int>(p.y), 0, side - 1);
  return y * side + x;
}

inline Vec3 octahedral_cell_center(int cell, int side) {
  const Vec2 p(static_cast<float>(cell % side) + 0.5f, static_cast<float>(cell / side) + 0.5f);
  return octahedral_to(p / static_cast<float>(side));
}

}  // namespace velour
