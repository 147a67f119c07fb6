// Half and difference angles of a direction pair [R98].
#pragma once

#include <algorithm>
#include <cmath>
#include "math/sphere/vec.h"

namespace velour {

// atan2 for table look-ups: measurements are evaluated millions of times, and libm's takes most of that time.

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

/// Radians. theta_h, theta_d in [0, pi/2]; phi_h in (-pi, pi]; phi_d in [0, pi], because exchanging wl and wv adds pi
/// to it and the tables that use it are reciprocal.
struct HalfDiff {
  float theta_h, phi_h, theta_d, phi_d;
};

/// Both directions above the horizon. Defined everywhere there: with the half vector on the normal phi_h is 0, with wl
/// = wv phi_d is 0. No arc cosine: angles come from lengths, so small ones keep their digits.
inline HalfDiff half_diff(const Vec3& wl, const Vec3& wv) {
  const Vec3 sum = wl + wv, diff = wl - wv;
  const float sum_xy_sq = sum.x * sum.x + sum.y * sum.y;
  const float sum_xy = std::sqrt(sum_xy_sq), sum_length = std::sqrt(sum_xy_sq + sum.z * sum.z);
  // diff along the tangents of growing theta_h and phi_h, both times |sum_xy| |sum|.
  const bool on_normal = sum_xy_sq == 0.0f;
  const float across = on_normal ? diff.y : (diff.y * sum.x - diff.x * sum.y) * sum_length;
  const float along = on_normal ? diff.x : (diff.x * sum.x + diff.y * sum.y) * sum.z - sum_xy_sq * diff.z;
  const float phi_d = fast_atan2(across, along);
  return {fast_atan2(sum_xy, sum.z), fast_atan2(sum.y, sum.x), fast_atan2(glm::length(diff), sum_length),
          phi_d < 0.0f ? phi_d + kPi : phi_d};
}

/// The pair of directions with given angles (radians); either direction may lie below the horizon.
DirectionPair pair_of_half_diff(double theta_h, double phi_h, double theta_d, double phi_d);

}  // namespace velour
