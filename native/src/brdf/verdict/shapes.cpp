#include "brdf/verdict/shapes.h"

#include <cmath>
#include <optional>

namespace velour {

namespace {

constexpr float kBallRadius = 0.94f;  // half the picture is 1
constexpr float kRingRadius = 0.64f, kTubeRadius = 0.3f;
constexpr float kRingTilt = 0.9f;  // radians, of the ring's axis against the view

Frame surface_frame(const Vec3& normal, const Vec3& along) {
  const Vec3 sideways = glm::cross(normal, along);
  const float length = glm::length(sideways);
  if (length < 1e-4f) return Frame::about(normal);
  const Vec3 y = sideways / length;
  return {glm::cross(y, normal), y, normal};
}

/// `frame_at(x, y)`: the surface at a point of the picture, or nothing.
template <class FrameAt>
Shape drawn(int side, const FrameAt& frame_at) {
  Shape shape;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto at = [&](int i) { return 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(side) - 1; };
      const std::optional<Frame> frame = frame_at(at(column), -at(row));
      if (frame) shape.pixels.push_back({static_cast<uint32_t>(row * side + column), *frame});
    }
  }
  return shape;
}

std::optional<Frame> ball_frame(float x, float y) {
  const float distance_sq = x * x + y * y;
  if (distance_sq >= kBallRadius * kBallRadius) return std::nullopt;
  const Vec3 normal = Vec3(x, y, std::sqrt(kBallRadius * kBallRadius - distance_sq)) / kBallRadius;
  return surface_frame(normal, {normal.z, 0, -normal.x});  // along the circles of latitude
}

/// Sphere tracing of the torus.
std::optional<Frame> ring_frame(float x, float y) {
  constexpr int kSteps = 96;
  constexpr float kClose = 1e-5f;
  const Vec3 axis(0, std::sin(kRingTilt), std::cos(kRingTilt));
  Vec3 p(x, y, 1);
  for (int i = 0; i < kSteps; ++i) {
    const float height = glm::dot(p, axis);
    const Vec3 outwards = p - height * axis;
    const float radius = std::max(glm::length(outwards), 1e-6f);
    const Vec3 from_tube = p - outwards * (kRingRadius / radius);
    const float distance = glm::length(from_tube) - kTubeRadius;
    if (distance < kClose) {
      const Vec3 normal = glm::normalize(from_tube);
      if (normal.z <= 0) return std::nullopt;
      return surface_frame(normal, glm::cross(axis, outwards));
    }
    p.z -= distance;
    if (p.z < -1) break;
  }
  return std::nullopt;
}

}  // namespace

Shape ball_shape(int side) { return drawn(side, ball_frame); }
Shape ring_shape(int side) { return drawn(side, ring_frame); }

}  // namespace velour
