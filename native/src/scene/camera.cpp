#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "math/sphere/warp.h"
#include "scene/motion.h"

namespace velour {

Shutter::Shutter(const std::vector<float>& opening) : density_(opening) {
  const auto wrong = std::ranges::find_if(opening, [](float x) { return !(x >= 0.0f && std::isfinite(x)); });
  if (wrong != opening.end()) {
    refuse("The shutter curve has the value " + std::to_string(*wrong) + "; values must be finite and at least 0.");
  }
  if (std::ranges::none_of(opening, [](float x) { return x > 0.0f; })) {
    refuse("The shutter curve is 0 everywhere, so the shutter never opens; raise a part of it.");
  }
  if (density_.size() == 1) density_.push_back(density_[0]);
  std::vector<double> below = {0.0};
  for (size_t i = 1; i < density_.size(); ++i) {
    below.push_back(below.back() + 0.5 * (static_cast<double>(density_[i - 1]) + static_cast<double>(density_[i])));
  }
  const double all = below.back(), pieces = static_cast<double>(density_.size() - 1);
  for (const double x : below) below_.push_back(static_cast<float>(x / all));
  for (float& x : density_) x = static_cast<float>(static_cast<double>(x) / all * pieces);
}

float Shutter::time(float u) const {
  const auto above = std::upper_bound(below_.begin() + 1, below_.end() - 1, u);
  const auto i = static_cast<size_t>(above - below_.begin()) - 1;
  const float a = density_[i], b = density_[i + 1], share = below_[i + 1] - below_[i];
  const float part = share > 0.0f ? std::clamp((u - below_[i]) / share, 0.0f, 1.0f) : 0.0f;
  // Root of the integral of a density that is linear from a to b, without cancellation.
  const float root = a + std::sqrt(a * a + part * (b * b - a * a));
  const float at = root > 0.0f ? std::min(part * (a + b) / root, 1.0f) : 0.0f;
  return (static_cast<float>(i) + at) / static_cast<float>(density_.size() - 1);
}

float Shutter::density(float time) const {
  const MotionTime at(density_.size(), time);
  return at.between(density_[at.before], density_[at.before + 1]);
}

namespace {

/// Rigid transform whose columns are the unit axes x, y, z and the origin.
Affine rigid(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& origin) {
  return {{x.x, y.x, z.x, origin.x, x.y, y.y, z.y, origin.y, x.z, y.z, z.z, origin.z}};
}

}  // namespace

Vec2 Aperture::sample(const Vec2& u) const {
  Vec2 place;
  if (blades < 3) {
    place = sample_uniform_disk(u);
  } else {
    const float side = 2.0f * kPi / static_cast<float>(blades);
    const float corner = std::min(std::floor(u.x * static_cast<float>(blades)), static_cast<float>(blades - 1));
    // Uniform on the triangle of the center and two adjacent corners.
    const float out = std::sqrt(u.x * static_cast<float>(blades) - corner), along = u.y * out;
    const float first = rotation + (corner - 0.5f) * side, second = first + side;
    place = (out - along) * Vec2(std::cos(first), std::sin(first)) + along * Vec2(std::cos(second), std::sin(second));
  }
  return radius * Vec2(place.x / ratio, place.y);
}

std::array<float, 4> Camera::window_at(float time) const {
  if (windows.empty()) return {window[0], window[1], window[2], window[3]};
  const MotionTime at(windows.size(), time);
  std::array<float, 4> found;
  for (size_t i = 0; i < 4; ++i) found[i] = at.between(windows[at.before][i], windows[at.before + 1][i]);
  return found;
}

Ray Camera::ray(const Vec2& picture, const Vec2& lens, float time) const {
  const Affine to_world = place(time);
  const std::array<float, 4> edges = window_at(time);
  const float x = edges[0] + picture.x * (edges[1] - edges[0]);
  const float y = edges[2] + picture.y * (edges[3] - edges[2]);
  const bool perspective = type == Type::perspective;
  // Slope from the lens point to where the ray through the lens center meets the focal plane, per unit of depth.
  const Vec2 slope = (perspective ? Vec2(x, y) : Vec2(0.0f)) - lens / aperture.focus;
  const Vec3 direction(slope, -1.0f);
  const float length = glm::length(direction);  // of the ray per unit of clip distance
  const Vec3 origin = to_world.point(perspective ? Vec3(lens, 0.0f) : Vec3(Vec2(x, y) + lens, 0.0f));
  return {origin, clip_start * length, glm::normalize(to_world.vector(direction)), clip_end * length, time};
}

float Camera::depth(const Vec3& world, float time) const {
  const Affine to_world = place(time);
  return -glm::dot(world - to_world.column(3), glm::normalize(to_world.column(2)));
}

Vec2 CameraProjection::picture(const Vec3& world) const {
  const Vec3 local = to_camera_.point(world);
  const Vec2 at = Vec2(local) / (type_ == Camera::Type::perspective ? -local.z : 1.0f);
  return {(at.x - window_[0]) / (window_[1] - window_[0]), (at.y - window_[2]) / (window_[3] - window_[2])};
}

Camera Camera::look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov, float aspect) {
  const Vec3 z = glm::normalize(eye - target);
  Vec3 x = glm::cross(up, z);
  // Any horizontal axis will do when looking along `up`; +x matches Blender's top view.
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
  // A box without extent still needs a distance that float32 can distinguish from 0.
  const float least = 1e-3f * std::max(glm::length(bounds.center()), 1.0f);
  const float fit = bounds.radius() > 0.0f ? std::max({tall, half.x / aspect, 1e-6f * bounds.radius()}) : least;
  const float distance = deep + kMargin * fit / std::tan(0.5f * kFov);
  return look_at(bounds.center() + distance * towards_viewer, bounds.center(), up, kFov, aspect);
}

}  // namespace velour
