// Warps from the unit square to the sphere; each comes with its density per solid angle.
#pragma once

#include <algorithm>

#include "sphere/vec.h"

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

}  // namespace velour
