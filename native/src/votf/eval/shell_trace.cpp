#include "votf/eval/shell_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace velour {
namespace {

constexpr float kOwnDepth = 2;  // pitches: maximum depth at which a ray that starts on the structure may seem to start

float squared(float x) { return x * x; }

/// Upper bound on the tile widths that a ray within the shell covers per meter.
float fastest(const ShellRay& ray, float sine, const VotfVolume& volume) {
  const float across = glm::length(ray.along) * sine;
  // Rays steepen within concave shells, and within convex ones on their way up.
  const float down = ray.scale * (ray.curvature < 0 || ray.height < 0 ? 1.0f : ray.cosine);
  // Toward the center of curvature the same length covers more of the surface. Bounded at a third of the radius.
  const float below = volume.top - volume.bottom + ray.height;
  const float radius = 1 - std::max(ray.curvature * below, ray.curvature * ray.height) / ray.scale;
  return std::sqrt(squared(across / squared(std::max(radius, 1.0f / 3))) + squared(down));
}

}  // namespace

float sine_of(const ShellRay& ray) { return std::sqrt(std::max(0.0f, 1.0f - squared(ray.cosine))); }

Vec3 ShellRay::at(float s) const { return place_on_ray(*this, s); }

ShellSpan span_of(const ShellRay& ray, const VotfVolume& volume) {
  // Radii r with 1 - r^2 = curvature * fall: s^2 curvature - 2 s cosine + fall = 0.
  const float down = (volume.top - volume.bottom) / ray.scale;
  const float fall = down * (2 - ray.curvature * down);
  const float square = ray.cosine * ray.cosine - ray.curvature * fall;
  if (square >= 0) return {fall / std::max(ray.cosine + std::sqrt(square), 1e-6f), true};
  return {2 * ray.cosine / ray.curvature, false};
}

ShellSpan span_from_side(const ShellRay& ray, const VotfVolume& volume, bool onwards) {
  // First positive root, as above, of s^2 curvature - 2 s cosine = rise (2 + curvature rise).
  const float down = onwards ? ray.cosine : -ray.cosine, infinite = std::numeric_limits<float>::infinity();
  const auto first = [&](float rise) {
    const float towards = rise < 0 ? down : -down, bends = rise < 0 ? -ray.curvature : ray.curvature;
    const float far = rise * (2 + ray.curvature * rise), square = down * down + ray.curvature * far;
    if (!(square >= 0)) return infinite;
    const float root = std::sqrt(square);
    if (towards < 0) return bends > 0 ? (root - towards) / bends : infinite;
    return towards + root > 0 ? std::abs(far) / (towards + root) : infinite;
  };
  const float bottom = first((volume.bottom - volume.top - ray.height) / ray.scale);
  const float top = first(-ray.height / ray.scale);
  return {std::min(bottom, top), bottom < top};
}

ShellWay::ShellWay(const ShellRay& along, const VotfVolume& volume, float from, float to, bool starts_on,
                   const ShellEdge& edge)
    : ray(along),
      begin(from),
      end(to),
      sine(sine_of(along)),
      speed(fastest(along, sine, volume)),
      own(0),
      offset(edge.offset) {
  if (starts_on) own = std::min(std::abs(end - begin), (kOwnDepth * volume.pitch() + edge.softness) / speed);
}

void trace_shells(const ShellField& field, std::span<const ShellWay> ways, ShellHit* hits) {
  for (size_t done = 0; done < ways.size(); done += kWaysTogether) {
    march_shells(field.table(), ways.subspan(done, std::min(kWaysTogether, ways.size() - done)), hits + done);
  }
}

ShellHit trace_shell(const ShellField& field, const ShellWay& way) {
  ShellHit hit;
  trace_shells(field, {&way, 1}, &hit);
  return hit;
}

ShellWay line_through(const VotfVolume& volume, const Vec2& place, const Vec3& w) {
  const Vec3 up = w.z < 0 ? -w : w;
  const float sine = std::sqrt(up.x * up.x + up.y * up.y);
  const Vec2 azimuth = sine > 0 ? Vec2(up.x, up.y) / sine : Vec2(1, 0);
  const Vec2 to_top = Vec2(up.x, up.y) * ((volume.top - volume.reference) / up.z);
  const ShellRay ray{place + to_top, -azimuth, up.z, 0.0f, 1.0f};
  return {ray, volume, 0.0f, span_of(ray, volume).end};
}

void lines_meet(const ShellField& field, std::span<const Vec2> places, const Vec3& w, uint8_t* meets) {
  const ShellWay through_origin = line_through(field.volume(), Vec2(0.0f), w);
  std::vector<ShellWay> ways(std::min(places.size(), kWaysTogether), through_origin);
  std::vector<ShellHit> hits(ways.size());
  for (size_t done = 0; done < places.size(); done += kWaysTogether) {
    const size_t count = std::min(kWaysTogether, places.size() - done);
    for (size_t i = 0; i < count; ++i) ways[i].ray.place = through_origin.ray.place + places[done + i];
    march_shells(field.table(), {ways.data(), count}, hits.data());
    for (size_t i = 0; i < count; ++i) meets[done + i] = hits[i].met ? 1 : 0;
  }
}

bool line_meets(const ShellField& field, const Vec2& place, const Vec3& w) {
  uint8_t meets;
  lines_meet(field, {&place, 1}, w, &meets);
  return meets != 0;
}

}  // namespace velour
