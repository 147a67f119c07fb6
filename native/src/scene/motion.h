// Motion while the shutter of the camera is open, from time 0 to 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "math/sphere/affine.h"

namespace velour {

/// Time at which everything is where it is without motion.
inline constexpr float kMiddleTime = 0.5f;
/// Maximum number of steps; the limit of Embree.
inline constexpr size_t kMaxMotionSteps = 129;

/// Place of a time among even steps from 0 to 1, of which there are at least 2: the same as Embree's.
struct MotionTime {
  size_t before;  // index of a step
  float next;     // weight of the step after it

  MotionTime(size_t steps, float time) {
    const float at = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(steps - 1);
    before = std::min(static_cast<size_t>(at), steps - 2);
    next = at - static_cast<float>(before);
  }
  template <class T>
  T between(const T& one, const T& other) const {
    return (1.0f - next) * one + next * other;
  }
};

/// Transform at a time, linear between `steps`.
inline Affine interpolated(std::span<const Affine> steps, float time) {
  const MotionTime at(steps.size(), time);
  Affine map;
  for (int i = 0; i < 12; ++i) map.m[i] = at.between(steps[at.before].m[i], steps[at.before + 1].m[i]);
  return map;
}

/// Steps whose linear interpolation follows the motion between `keys`, transforms at even times: rotations turn evenly,
/// stretch and translation are linear, as in Cycles. Between two steps the rotation is at most kMaxTurn, unless that
/// takes more than kMaxMotionSteps; things on the chord are then up to kMaxTurn^2 / 8 closer to the axis. Empty if all
/// keys are equal.
std::vector<Affine> motion_steps(std::span<const Affine> keys);
inline constexpr double kMaxTurn = 1.0 / 32;  // radians

}  // namespace velour
