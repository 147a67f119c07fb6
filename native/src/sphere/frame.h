// Orthonormal frames about a direction.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Columns are tangent x, tangent y and the axis z. `to_local(v) = transpose(m) v`.
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  /// Frame about unit `axis`; continuous except where axis.z changes sign (Duff et al. 2017, JCGT 6(1), Listing 3).
  static Frame about(const Vec3& axis) {
    const float sign = std::copysign(1.0f, axis.z);
    const float a = -1.0f / (sign + axis.z);
    const float b = axis.x * axis.y * a;
    return {
        {1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x}, {b, sign + axis.y * axis.y * a, -axis.y}, axis};
  }

  Vec3 to_world(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 to_local(const Vec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
};

/// Smallest rotation that takes unit `from` to unit `to`. Opposite directions rotate about an axis normal to `from`.
Mat3 rotation_between(const Vec3& from, const Vec3& to);

}  // namespace velour
