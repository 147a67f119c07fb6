// 3 x 4 affine transforms between the spaces of a scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include "math/sphere/vec.h"

namespace velour {

/// Row-major: m[4 * row + column]; the last column is the translation.
struct Affine {
  float m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  Vec3 column(int i) const { return {m[i], m[4 + i], m[8 + i]}; }
  Vec3 vector(const Vec3& v) const { return v.x * column(0) + v.y * column(1) + v.z * column(2); }
  Vec3 point(const Vec3& p) const { return vector(p) + column(3); }
  /// Transforms normals: the inverse transpose up to a positive factor, so that the outside of a mirrored object stays
  /// its outside.
  Mat3 normal_map() const {
    float largest = 1e-37f;  // columns are divided by it, so that their products neither vanish nor overflow
    for (int i = 0; i < 3; ++i) largest = std::max(largest, glm::length(column(i)));
    const Vec3 x = column(0) / largest, y = column(1) / largest, z = column(2) / largest;
    const Vec3 yz = glm::cross(y, z);
    const float sign = glm::dot(x, yz) < 0.0f ? -1.0f : 1.0f;
    return sign * Mat3(yz, glm::cross(z, x), glm::cross(x, y));
  }
  /// False for a transform that flattens, for example by a zero scale.
  bool invertible() const {
    const double d = glm::determinant(glm::dmat3(Vec3d(column(0)), Vec3d(column(1)), Vec3d(column(2))));
    return std::abs(d) > 1e-36;
  }
  /// The transform must be invertible.
  Affine inverse() const {
    const glm::dmat3 back = glm::inverse(glm::dmat3(Vec3d(column(0)), Vec3d(column(1)), Vec3d(column(2))));
    const Vec3d shift = -(back * Vec3d(column(3)));
    Affine a;
    for (int row = 0; row < 3; ++row) {
      for (int c = 0; c < 3; ++c) a.m[4 * row + c] = static_cast<float>(back[c][row]);
      a.m[4 * row + 3] = static_cast<float>(shift[row]);
    }
    return a;
  }
  bool finite() const {
    for (float x : m) {
      if (!std::isfinite(x)) return false;
    }
    return true;
  }
  bool operator==(const Affine&) const = default;
};

// Bounding boxes.

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

// Bounding boxes of transformed objects.

/// World-space box of the transformed corners of `box`; encloses everything in `box`.
inline Bounds box_around(const Bounds& box, const Affine& to_world) {
  Bounds bounds;
  for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
    const Vec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                 corner & 4 ? box.high.z : box.low.z);
    bounds.add(to_world.point(p));
  }
  return bounds;
}

}  // namespace velour
