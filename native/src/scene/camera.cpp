#include "scene/camera.h"

#include <algorithm>

namespace velour {
namespace {

/// Rigid map whose columns are the unit axes x, y, z and the origin.
Affine rigid(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& origin) {
  return {{x.x, y.x, z.x, origin.x, x.y, y.y, z.y, origin.y, x.z, y.z, z.z, origin.z}};
}

}  // namespace

Ray Camera::ray(const Vec2& picture) const {
  const float x = window[0] + picture.x * (window[1] - window[0]);
  const float y = window[2] + picture.y * (window[3] - window[2]);
  if (type == Type::orthographic) {
    return {camera_to_world.point({x, y, 0}), clip_start, glm::normalize(camera_to_world.vector({0, 0, -1})), clip_end};
  }
  const float length = std::sqrt(x * x + y * y + 1.0f);  // of the ray from one clip unit to the next
  return {camera_to_world.column(3), clip_start * length, glm::normalize(camera_to_world.vector({x, y, -1})),
          clip_end * length};
}

float Camera::depth(const Vec3& world) const {
  return -glm::dot(world - camera_to_world.column(3), glm::normalize(camera_to_world.column(2)));
}

Camera Camera::look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov, float aspect) {
  const Vec3 z = glm::normalize(eye - target);
  Vec3 x = glm::cross(up, z);
  // Looking along the up direction: any horizontal axis will do, +x is the one Blender's top view has.
  x = glm::dot(x, x) > 1e-12f ? glm::normalize(x) : Vec3(1, 0, 0);
  Camera camera;
  camera.camera_to_world = rigid(x, glm::cross(z, x), z, eye);
  const float half = std::tan(0.5f * fov);
  camera.window[0] = -half * aspect;
  camera.window[1] = half * aspect;
  camera.window[2] = -half;
  camera.window[3] = half;
  return camera;
}

Camera Camera::framing(const Bounds& bounds, float aspect, int up_axis) {
  constexpr float kFov = 40.0f * (kPi / 180.0f);
  constexpr float kMargin = 1.05f;
  if (bounds.empty()) return look_at({0, -1, 0}, {0, 0, 0}, {0, 0, 1}, kFov, aspect);
  const Vec3 up = up_axis == 1 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  const Vec3 towards_viewer = up_axis == 1 ? Vec3(0, 0, 1) : Vec3(0, -1, 0);
  const Vec3 half = 0.5f * (bounds.high - bounds.low);
  const float tall = up_axis == 1 ? half.y : half.z;
  const float deep = up_axis == 1 ? half.z : half.y;
  // A box without extent still needs a distance that float32 can tell from none.
  const float least = 1e-3f * std::max(glm::length(bounds.center()), 1.0f);
  const float fit = bounds.radius() > 0.0f ? std::max({tall, half.x / aspect, 1e-6f * bounds.radius()}) : least;
  const float distance = deep + kMargin * fit / std::tan(0.5f * kFov);
  return look_at(bounds.center() + distance * towards_viewer, bounds.center(), up, kFov, aspect);
}

}  // namespace velour
