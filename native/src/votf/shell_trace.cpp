#include "votf/shell_trace.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr float kNear = 0.03f;    // pitches: nearer than this is within
constexpr float kLeast = 0.1f;    // pitches: no step is shorter
constexpr float kStride = 1.6f;   // distances that a step is long [KSK14]
constexpr float kOwnDepth = 2;    // pitches: how deep within the structure a ray may seem to start that starts on it
constexpr int kMostLooks = 64;    // for the deepest place of a ray within the structure
constexpr int kMostSteps = 4096;  // a ray that glides along a surface for so long has met it

float squared(float x) { return x * x; }

/// Widths that a ray within the shell covers a metre, at most.
float fastest(const ShellRay& ray, const OcclusionVolume& volume) {
  const float across = glm::length(ray.along) * std::sqrt(std::max(0.0f, 1.0f - squared(ray.cosine)));
  const float down = ray.scale * (ray.curvature < 0 ? 1.0f : ray.cosine);  // a hollow's rays steepen
  // Towards the centre of the curvature the same way covers more of the surface; not beyond a third of the radius.
  const float radius = 1 - std::max(0.0f, ray.curvature) * (volume.top - volume.bottom) / ray.scale;
  return std::sqrt(squared(across / squared(std::max(radius, 1.0f / 3))) + squared(down));
}

/// Angle / tangent for angles up to about 1: the series of the arc tangent.
float arc_over_tangent(float tangent) {
  const float t2 = tangent * tangent;
  return 1.0f - t2 * (1.0f / 3 - t2 * (0.2f - t2 * (1.0f / 7)));
}

Vec3 place_on(const ShellRay& ray, float sine, float s) {
  const float a = s * sine;
  if (ray.curvature == 0) return {ray.place + ray.along * a, -ray.scale * s * ray.cosine};
  // In radii of the top: `bent` across and `b` up from the centre. A ray that passes beside the centre further than 84
  // degrees on is held there.
  const float bent = ray.curvature * a;
  const float b = std::max(1.0f - ray.curvature * s * ray.cosine, 0.1f * std::abs(bent));
  const float deeper = s * (ray.curvature * s - 2 * ray.cosine) / (1 + std::sqrt(b * b + bent * bent));
  const float across = b > 0 ? a / b * arc_over_tangent(std::min(1.0f, std::abs(bent) / b)) : 0.0f;
  return {ray.place + ray.along * across, ray.scale * deeper};
}

float sine_of(const ShellRay& ray) { return std::sqrt(std::max(0.0f, 1.0f - squared(ray.cosine))); }

}  // namespace

Vec3 ShellRay::at(float s) const { return place_on(*this, sine_of(*this), s); }

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
  const float pitch = volume.pitch(), way = end < begin ? -1.0f : 1.0f, speed = fastest(ray, volume);
  const float sine = sine_of(ray);
  const auto place_at = [&](float s) { return place_on(ray, sine, s) + Vec3(0, 0, volume.top); };
  float s = begin, free = 0, step = 0;  // the last look was `step` before, in widths, and `free` of any surface
  for (int i = 0; i < kMostSteps; ++i) {
    const Vec3 place = place_at(s);
    const float distance = field.distance(place);
    if (distance <= kNear * pitch) {
      if (step == 0) return ShellHit{s, place};
      // Between the two looks, where the distance falls to nothing.
      s -= way * step / speed * std::min(1.0f, distance / (distance - free));
      return ShellHit{s, place_at(s)};
    }
    if (free + distance < step) {  // between the two there may be something: back to what is free for certain
      s -= way * (step - free) / speed;
      step = free;
      continue;
    }
    free = std::max(distance, kLeast * pitch);
    step = kStride * free;
    s += way * step / speed;
    if ((s - end) * way >= 0) {
      if ((s - way * (step - free) / speed - end) * way >= 0) return std::nullopt;
      step -= std::abs(s - end) * speed;
      s = end;
    }
  }
  return ShellHit{s, place_at(s)};
}

float off_structure(const ShellField& field, const ShellRay& ray, float begin, float end) {
  const OcclusionVolume& volume = field.volume();
  const float pitch = volume.pitch(), speed = fastest(ray, volume), sine = sine_of(ray);
  const float way = end < begin ? -1.0f : 1.0f, most = std::min(std::abs(end - begin), kOwnDepth * pitch / speed);
  for (float on = 0; on < most;) {
    const float s = begin + way * on, distance = field.distance(place_on(ray, sine, s) + Vec3(0, 0, volume.top));
    if (distance > kNear * pitch) return s;
    on += std::max(std::abs(distance), kLeast * pitch) / speed;
  }
  return begin;
}

ShellDepth depth_behind(const ShellField& field, const ShellRay& ray, float s, float end, float most) {
  const OcclusionVolume& volume = field.volume();
  const float pitch = volume.pitch(), speed = fastest(ray, volume), way = end < s ? -1.0f : 1.0f, sine = sine_of(ray);
  ShellDepth deepest{0, Vec3(0.0f)};
  Vec3 place = place_on(ray, sine, s);
  for (int i = 0; i < kMostLooks && (end - s) * way > 0 && deepest.depth < most; ++i) {
    const Vec3 at = place_on(ray, sine, s);
    const float depth = -field.distance(at + Vec3(0, 0, volume.top));
    if (depth > deepest.depth) {
      deepest.depth = depth;
      place = at;
    }
    s += way * std::max(std::abs(depth), 0.5f * pitch) / speed;
  }
  deepest.depth = std::min(deepest.depth, most);
  const Vec3 slope = field.gradient(place + Vec3(0, 0, volume.top)),
             along = glm::normalize(place_on(ray, sine, s) - place);
  const Vec3 across = slope - glm::dot(slope, along) * along;
  const float length = glm::length(across);
  if (length > 0) deepest.normal = across / length;
  return deepest;
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
