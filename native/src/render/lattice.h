// Point sets of the unit square for the directions of one camera ray.
#pragma once

#include <algorithm>
#include <cmath>

#include "sphere/vec.h"

namespace velour {

/// Point `i` of `n` of a Fibonacci-like rank-1 lattice, shifted by `shift` modulo 1 [CP76]. With a uniform shift every
/// point is uniform in [0, 1)^2, and together they cover the square evenly.
inline Vec2 lattice_point(int i, int n, const Vec2& shift) {
  constexpr float kGoldenRatio = 0.618033989f;
  const float x = static_cast<float>(i) / static_cast<float>(n) + shift.x;
  const float y = static_cast<float>(i) * kGoldenRatio + shift.y;
  constexpr float kBelowOne = 0x1.fffffep-1f;
  return {std::min(x - std::floor(x), kBelowOne), std::min(y - std::floor(y), kBelowOne)};
}

}  // namespace velour
