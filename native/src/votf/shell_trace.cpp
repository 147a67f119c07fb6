#include "votf/shell_trace.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr float kNear = 0.02f;    // pitches: nearer than this is within
constexpr float kLeast = 0.1f;    // pitches: no step is shorter
constexpr int kMostSteps = 4096;  // a ray that glides along a surface for so long has met it

float squared(float x) { return x * x; }

/// Angle / tangent for angles up to about 1: the series of the arc tangent.
float arc_over_tangent(float tangent) {
  const float t2 = tangent * tangent;
  return 1.0f - t2 * (1.0f / 3 - t2 * (0.2f - t2 * (1.0f / 7)));
}

}  // namespace

ShellRay::Point ShellRay::at(float s) const {
  const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
  // In radii of the top: `a` across and `b` up from the centre. A ray that passes beside the centre further than 84
  // degrees on is held there.
  const float a = s * sine, b = std::max(1.0f - curvature * s * cosine, 0.1f * std::abs(curvature * a));
  const float square = b * b + curvature * curvature * a * a, radius = std::sqrt(square);
  const float deeper = s * (curvature * s - 2 * cosine) / (1 + radius);
  const float across = b > 0 ? a / b * arc_over_tangent(std::min(1.0f, std::abs(curvature * a) / b)) : 0.0f;
  return {{place + along * across, scale * deeper}, square};
}

ShellSpan span_of(const ShellRay& ray, const OcclusionVolume& volume) {
  // Radii r with 1 - r^2 = curvature * fall: s^2 curvature - 2 s cosine + fall = 0.
  const float down = (volume.top - volume.bottom) / ray.scale;
  const float fall = down * (2 - ray.curvature * down);
  const float square = ray.cosine * ray.cosine - ray.curvature * fall;
  if (square >= 0) return {fall / std::max(ray.cosine + std::sqrt(square), 1e-6f), true};
  return {2 * ray.cosine / ray.curvature, false};
}

std::optional<ShellHit> trace_shell(const ShellField& field, const ShellRay& ray, float begin, float end) {
  const OcclusionVolume& volume = field.volume();
  const float pitch = volume.pitch(), way = end < begin ? -1.0f : 1.0f;
  const float across = glm::length(ray.along) * std::sqrt(std::max(0.0f, 1.0f - ray.cosine * ray.cosine));
  const float down = ray.scale * (ray.curvature < 0 ? 1.0f : ray.cosine);  // a hollow's rays steepen
  float s = begin;
  for (int i = 0; i < kMostSteps; ++i) {
    ShellRay::Point point = ray.at(s);
    point.place.z += volume.top;
    const float distance = field.distance(point.place);
    if (distance <= kNear * pitch) return ShellHit{s, point.place};
    // Widths a metre; it grows towards the centre of the curvature, by less than a tenth from one step to the next.
    const float speed = std::sqrt(squared(1.1f * across / point.slower) + down * down);
    s += way * std::max(distance, kLeast * pitch) / speed;
    if ((s - end) * way >= 0) return std::nullopt;
  }
  ShellRay::Point point = ray.at(s);
  return ShellHit{s, {point.place.x, point.place.y, point.place.z + volume.top}};
}

bool line_meets(const ShellField& field, const Vec2& place, const Vec3& w) {
  const OcclusionVolume& volume = field.volume();
  const Vec3 up = w.z < 0 ? -w : w;
  const float sine = std::sqrt(up.x * up.x + up.y * up.y);
  const Vec2 azimuth = sine > 0 ? Vec2(up.x, up.y) / sine : Vec2(1, 0);
  ShellRay ray{place, -azimuth, up.z, 0.0f, 1.0f};
  ray.place += Vec2(up.x, up.y) * ((volume.top - volume.reference) / up.z);
  return trace_shell(field, ray, 0.0f, span_of(ray, volume).end).has_value();
}

}  // namespace velour
