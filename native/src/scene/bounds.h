// Bounding boxes.
#pragma once

#include <limits>

#include "sphere/vec.h"

namespace velour {

/// Axis-aligned box; empty while low > high.
struct Bounds {
  Vec3 low{std::numeric_limits<float>::infinity()};
  Vec3 high{-std::numeric_limits<float>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  void add(const Vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  /// Whether the box contains all of `other`, which may be empty.
  bool holds(const Bounds& other) const {
    return glm::all(glm::lessThanEqual(low, other.low)) && glm::all(glm::greaterThanEqual(high, other.high));
  }
  Vec3 center() const { return 0.5f * (low + high); }
  /// Radius of the bounding sphere around center(); 0 for an empty box.
  float radius() const { return empty() ? 0.0f : 0.5f * glm::length(high - low); }
};

}  // namespace velour
