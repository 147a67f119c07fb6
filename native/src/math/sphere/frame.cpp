#include "math/sphere/frame.h"

namespace velour {

Mat3 rotation_between(const Vec3& from_float, const Vec3& to_float) {
  // Rodrigues' formula with axis v = from x to (length sin) and c = from . to (cos): R = c I + [v] + v v^T / (1 + c).
  // Computed in double because 1 + c cancels for nearly opposite directions.
  const Vec3d from = glm::normalize(Vec3d(from_float)), to = glm::normalize(Vec3d(to_float));
  const double c = glm::dot(from, to);
  if (c < -1.0 + 1e-10) {
    const Vec3d axis = glm::normalize(Vec3d(Frame::about(from_float).x));  // rotation by pi: R = 2 a a^T - I
    return Mat3(2.0 * glm::outerProduct(axis, axis) - glm::dmat3(1.0));
  }
  const Vec3d v = glm::cross(from, to);
  const glm::dmat3 cross_v(Vec3d(0, v.z, -v.y), Vec3d(-v.z, 0, v.x), Vec3d(v.y, -v.x, 0));
  return Mat3(c * glm::dmat3(1.0) + cross_v + glm::outerProduct(v, v) / (1.0 + c));
}

}  // namespace velour
