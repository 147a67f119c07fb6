// Functions of numbers that several operations share; what is undefined is 0, as in Blender.
#pragma once

#include <algorithm>
#include <cmath>
#include "math/sphere/vec.h"

namespace velour {

inline float ratio(float a, float b) { return b != 0 ? a / b : 0.0f; }
inline float fraction(float a) { return a - std::floor(a); }
inline float saturated(float a) { return std::min(std::max(a, 0.0f), 1.0f); }
inline float mixed(float a, float b, float share) { return a + share * (b - a); }

/// `a` moved by multiples of |max - min| into the interval between them.
inline float wrapped(float a, float max, float min) {
  const float range = max - min;
  return range != 0 ? a - range * std::floor((a - min) / range) : min;
}

/// 0 below 0, 1 above 1, 3 a^2 - 2 a^3 in between.
inline float smoothed(float a) {
  const float x = saturated(a);
  return x * x * (3 - 2 * x);
}
/// The same with a second derivative of 0 at both ends.
inline float smoother(float a) {
  const float x = saturated(a);
  return x * x * x * (x * (x * 6 - 15) + 10);
}

inline Vec3 unit_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : Vec3(0.0f);
}

}  // namespace velour
