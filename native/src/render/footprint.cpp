#include "render/footprint.h"

#include <algorithm>
#include <cmath>

#include "material/material.h"
#include "math/sphere/frame.h"

namespace velour {
namespace {

constexpr float kMinPart = 0.125f;  // minimum share of a pixel's side

bool varies(const Scene& scene) {
  return std::ranges::any_of(scene.materials(), [](const SurfaceMaterial& m) { return m.material->varies(); });
}

}  // namespace

RaySides across(const RayCone& cone, const Vec3& direction) {
  const Frame frame = Frame::about(direction);
  return {cone.width * frame.x, cone.width * frame.y};
}

PixelFootprint::PixelFootprint(const Scene& scene, int width, int height, int camera_rays)
    : camera_(scene.camera()),
      needed_(varies(scene)),
      part_(std::max(kMinPart, 1.0f / std::sqrt(static_cast<float>(camera_rays)))) {
  const Vec2 window(camera_.window[1] - camera_.window[0], camera_.window[3] - camera_.window[2]);
  pitch_ = part_ * window / Vec2(static_cast<float>(width), static_cast<float>(height));
}

RayCone PixelFootprint::cone_along(const Vec3& direction, float time) const {
  const float side = std::sqrt(std::abs(pitch_.x * pitch_.y));
  if (camera_.type == Camera::Type::orthographic) return {side, 0.0f, part_};
  // A pixel lies at distance 1 / cosine from the eye, and its area appears scaled by the cosine.
  const float cosine = std::max(0.0f, -glm::dot(direction, camera_.place(time).column(2)));
  return {0.0f, side * std::sqrt(cosine) * cosine, part_};
}

RaySides PixelFootprint::sides(const Vec3& position, float time) const {
  const Affine place = camera_.place(time);
  const float scale = camera_.type == Camera::Type::orthographic ? 1.0f : camera_.depth(position, time);
  return {scale * pitch_.x * place.column(0), scale * pitch_.y * place.column(1)};
}

Mat2 texture_footprint(const RaySides& sides, const Vec3& direction, const Vec3& normal, const TexturePoint& texture) {
  const float slope =
      std::copysign(std::max(std::abs(glm::dot(normal, direction)), kMinSlope), glm::dot(normal, direction));
  const auto side = [&](const Vec3& s) {
    const Vec3 on_plane = s - glm::dot(normal, s) / slope * direction;
    return Vec2(glm::dot(texture.u_gradient, on_plane), glm::dot(texture.v_gradient, on_plane));
  };
  return {side(sides.x), side(sides.y)};
}

uint64_t untextured_instances(const Scene& scene) {
  const auto varies = [&](uint32_t number) {
    const SurfaceMaterial& material = scene.materials()[number];
    return material.uv_sets > 0 && material.material->varies();
  };
  return static_cast<uint64_t>(std::ranges::count_if(scene.instances(), [&](const Scene::Instance& i) {
    return !scene.meshes()[i.mesh].has_uvs() && std::ranges::any_of(i.materials, varies);
  }));
}

}  // namespace velour
