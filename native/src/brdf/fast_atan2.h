// atan2 for table look-ups: measurements are evaluated millions of times, and libm's takes most of that time.
#pragma once

#include <algorithm>
#include <cmath>

namespace velour {

/// atan2(y, x) in radians, absolute error below 3e-7; 0 at the origin. Abramowitz & Stegun 4.4.49 on [0, 1].
inline float fast_atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay);
  const float t = larger > 0.0f ? std::min(ax, ay) / larger : 0.0f;
  const float s = t * t;
  float p = 0.0028662257f;
  p = p * s - 0.0161657367f;
  p = p * s + 0.0429096138f;
  p = p * s - 0.0752896400f;
  p = p * s + 0.1065626393f;
  p = p * s - 0.1420889944f;
  p = p * s + 0.1999355085f;
  p = p * s - 0.3333314528f;
  float angle = t + t * s * p;
  if (ay > ax) angle = 1.57079632679f - angle;
  if (x < 0.0f) angle = 3.14159265359f - angle;
  return std::copysign(angle, y);
}

}  // namespace velour
