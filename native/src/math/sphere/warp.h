// Warps from the unit square to the sphere; each comes with its density per solid angle.
#pragma once

#include <algorithm>
#include "math/sphere/vec.h"

namespace velour {

/// Uniform on the upper hemisphere.
inline Vec3 sample_uniform_hemisphere(const Vec2& u) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - u.x * u.x));
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), u.x};
}
inline float pdf_uniform_hemisphere(const Vec3& w) { return w.z > 0.0f ? 0.5f / kPi : 0.0f; }

/// Uniform on the sphere; density 1 / (4 pi).
inline Vec3 sample_uniform_sphere(const Vec2& u) {
  const float z = 1.0f - 2.0f * u.x;
  const float r = 2.0f * std::sqrt(u.x * (1.0f - u.x));
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Proportional to the cosine with +z, on the upper hemisphere.
inline Vec3 sample_cosine_hemisphere(const Vec2& u) {
  const float r = std::sqrt(u.x);
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u.x)};
}
inline float pdf_cosine_hemisphere(const Vec3& w) { return std::max(w.z, 0.0f) / kPi; }

/// Uniform on the unit disk (polar map).
inline Vec2 sample_uniform_disk(const Vec2& u) {
  const float r = std::sqrt(u.x);
  const float phi = 2.0f * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}

// Octahedral map of the sphere to a square grid of cells, for tables over directions.

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
