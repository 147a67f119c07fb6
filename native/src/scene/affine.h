// 3 x 4 affine transforms between the spaces of a scene.
#pragma once

#include <algorithm>
#include <cmath>

#include "sphere/vec.h"

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

}  // namespace velour
