// 3 x 4 affine maps between the spaces of a scene.
#pragma once

#include <span>

#include "sphere/vec.h"

namespace velour {

/// Row-major: m[4 * row + column], the last column is the shift.
struct Affine {
  float m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  Vec3 column(int i) const { return {m[i], m[4 + i], m[8 + i]}; }
  Vec3 vector(const Vec3& v) const { return v.x * column(0) + v.y * column(1) + v.z * column(2); }
  Vec3 point(const Vec3& p) const { return vector(p) + column(3); }
  /// Takes normals to normals: the inverse transpose up to a positive factor, so that the outside of a
  /// mirrored object stays its outside.
  Mat3 normal_map() const {
    const Vec3 yz = glm::cross(column(1), column(2));
    const float sign = glm::dot(column(0), yz) < 0.0f ? -1.0f : 1.0f;
    return sign * Mat3(yz, glm::cross(column(2), column(0)), glm::cross(column(0), column(1)));
  }
  bool finite() const {
    for (float x : m) {
      if (!std::isfinite(x)) return false;
    }
    return true;
  }
  bool operator==(const Affine&) const = default;
};

}  // namespace velour
