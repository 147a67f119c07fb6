#include "render/vertex.h"

namespace velour {
namespace {

Vec3 facing(const Vec3& v, const Vec3& towards) { return glm::dot(v, towards) < 0.0f ? -v : v; }

/// Frame about unit `z` with +x along `tangent` where that gives a direction.
Frame frame_along(const Vec3& z, const Vec3& tangent) {
  const Vec3 x = tangent - glm::dot(tangent, z) * z;
  const float length_sq = glm::dot(x, x);
  if (!(length_sq > 1e-6f * glm::dot(tangent, tangent)) || !(length_sq > 0.0f)) return Frame::about(z);
  const Vec3 unit_x = x / std::sqrt(length_sq);
  return {unit_x, glm::cross(z, unit_x), z};
}

}  // namespace

Vertex::Vertex(const SurfacePoint& point, const Vec3& wv_world)
    : position(point.position),
      geometric_normal(facing(point.geometric_normal, wv_world)),
      // Twice the bound: one for this point, one for where the ray tracer puts the triangle.
      offset(4.0f * point.error),
      surface(nullptr),
      table(nullptr) {
  Vec3 normal = facing(point.shading_normal, geometric_normal);
  const float cosine = glm::dot(normal, wv_world);
  if (cosine < kLeastCosine) normal = glm::normalize(normal + (kLeastCosine - cosine) * wv_world);
  frame = frame_along(normal, point.tangent);
  wv = frame.to_local(wv_world);
}

}  // namespace velour
