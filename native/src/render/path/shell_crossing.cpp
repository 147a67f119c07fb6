#include "render/path/shell_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/path/path_numbers.h"
#include "votf/eval/shell_trace.h"

namespace velour {
namespace {

/// Minimum cosine of texture look-ups; below it, the texels would be ever farther away.
constexpr float kMinCosine = 0.15f;
/// Offset of rays that start on a structure, in pitches, so that they do not hit it again at once.
constexpr float kOffStructure = 0.3f;

/// Minimum radius of curvature below the top, as a share of that at the top.
constexpr float kMinRadius = 0.1f;

/// Ways that differ by less than this factor come from the triangles, not from a fold.
constexpr float kSameSpan = 2;

Vec3 downwards(const Ray& ray, const Hit& top) {
  return glm::dot(ray.direction, top.geometric_normal) > 0 ? -ray.direction : ray.direction;
}

bool goes_in(const Ray& ray, const Hit& hit) { return glm::dot(ray.direction, hit.geometric_normal) < 0; }

}  // namespace

ShellCrossing::ShellCrossing(const Scene& scene, const Ray& ray, const Hit& hit)
    : scene_(scene),
      foot_(scene.shell_foot(hit)),
      direction_(downwards(ray, foot_.top)),
      leaving_(direction_ != ray.direction),
      crossing_(ray.origin + hit.distance * ray.direction),
      side_normal_(hit.geometric_normal),
      frame_(scene.shell(foot_.top, direction_)) {
  ShellEdge edge{frame_.softness};
  if (edge.softness > 0) edge.offset = edge.softness * (ray_number(ray, hit, RayDecision::shell_edge) - 0.5f);
  if (!foot_.is_side && !leaving_) flatten(ray, hit);
  way_ = foot_.is_side ? way_at_side(ray, hit, edge) : way_behind(in_shell(), hit, edge);
  if (!way_.empty() && scene.has_sides(hit)) end_at_sides(ray, hit);
}

ShellRay ShellCrossing::in_shell() const {
  const Vec2 widths(1, field().volume().aspect);
  return {.place = widths * frame_.uv,
          .along = widths * frame_.uv_along,
          .cosine = std::clamp(-glm::dot(direction_, frame_.normal), foot_.is_side ? -1.0f : 0.0f, 1.0f),
          .curvature = frame_.curvature,
          .scale = frame_.scale};
}

ShellWay ShellCrossing::way_behind(const ShellRay& ray, const Hit& hit, const ShellEdge& edge) const {
  const VotfVolume& volume = field().volume();
  // At the silhouette of the smooth surface the ray passes by, whatever the triangles are.
  if (!(ray.cosine > 0)) return {ray, volume, 0, 0};
  const ShellSpan span = span_of(ray, volume);
  if (!leaving_) return {ray, volume, 0, span.end, false, edge};
  if (hit.distance < span.end) return {ray, volume, hit.distance, 0, true, edge};
  // A ray that entered through the top has been decided there.
  return {ray, volume, span.through_bottom ? span.end : 0, 0, false, edge};
}

/// A ray that enters at a sharp fold would leave through the top at once if the surface went on to bend as it does at
/// the crossing. Gives it the curvature with which it leaves where it crosses the top again, if that is much farther.
void ShellCrossing::flatten(const Ray& ray, const Hit& hit) {
  const ShellRay way = in_shell();
  if (!(way.cosine > 0)) return;
  const ShellSpan span = span_of(way, field().volume());
  if (span.through_bottom) return;
  // A flatter surface than this leads the ray through the bottom.
  const float far = 4 * height() / way.cosine;
  if (!(far > kSameSpan * span.end)) return;
  const float near = std::nextafter(hit.distance, std::numeric_limits<float>::infinity());
  const float top = scene_.next_top(hit, {ray.origin, near, ray.direction, hit.distance + far, ray.time}, false);
  const float end = std::min(top - hit.distance, far);
  if (!(end > kSameSpan * span.end)) return;
  const float share = span.end / end;
  frame_.curvature *= share;
  frame_.normal_turn *= share;
}

ShellWay ShellCrossing::way_at_side(const Ray& ray, const Hit& hit, const ShellEdge& edge) {
  const VotfVolume& volume = field().volume();
  ShellRay way = in_shell();
  way.height = -foot_.below * (volume.top - volume.bottom);
  // Below the top of a convex shell the radius is smaller.
  const float radius = std::max(kMinRadius, 1 + frame_.curvature * way.height / way.scale);
  way.along /= radius;
  way.curvature /= radius;
  frame_.normal_turn /= radius;
  const bool in = goes_in(ray, hit);
  const float travel = leaving_ ? -1.0f : 1.0f;
  const ShellSpan span = span_from_side(way, volume, in != leaving_);
  if (in) return {way, volume, 0, travel * span.end, false, edge};
  if (hit.distance < span.end) return {way, volume, -travel * hit.distance, 0, true, edge};
  return {way, volume, span.through_bottom ? -travel * span.end : 0, 0, false, edge};
}

/// A ray that leaves through a side continues outside; one that entered through a side has been decided there.
void ShellCrossing::end_at_sides(const Ray& ray, const Hit& hit) {
  if (foot_.is_side ? goes_in(ray, hit) : !leaving_) {
    const float way = way_.end - way_.begin, far = hit.distance + std::abs(way);
    const float side = scene_.next_side(hit, {ray.origin, hit.distance, ray.direction, far, ray.time}, false);
    way_.end = side <= far ? std::copysign(side - hit.distance, way) : way_.end;
    if (!std::isfinite(way_.end)) way_.end = way_.begin;
  } else {
    const float from = std::max(0.0f, hit.distance - std::abs(way_.end - way_.begin));
    const float side = scene_.next_side(hit, {ray.origin, from, ray.direction, hit.distance, ray.time}, true);
    if (side <= hit.distance) way_.end = way_.begin;
  }
}

bool ShellCrossing::find() {
  const Hit& top = foot_.top;
  hit_.met = false;
  if (!std::isnan(top.shell_s)) {  // already known
    hit_ = {true, top.shell_begin, top.shell_s, way_.ray.at(top.shell_s) + Vec3(0, 0, field().volume().top)};
  } else if (!way_.empty()) {
    hit_ = trace_shell(field(), way_);
  }
  return hit_.met;
}

Vec2 ShellCrossing::beyond_outline(const Vec2& texels) const {
  const VotfVolume& volume = field().volume();
  const Vec2 texel = Vec2(1, volume.aspect) / texels;
  // Half the extent of the mean of a texel and the interpolation between texels.
  const float most = std::min(1.5f * std::max(texel.x, texel.y), 0.9f * volume.reach);
  const ShellOutline outline = outline_beside(field(), way_, hit_.s, most);
  const Vec2 across(outline.outside);
  const float square = glm::dot(across, across);
  if (!(outline.depth < std::min(most, 1.5f * glm::length(across * texel))) || !(square > 0)) return Vec2(0.0f);
  const Vec2 over = across * (2 * outline.depth / square);
  // There is no silhouette where other structure lies behind.
  ShellWay beside = way_;
  beside.ray.place += over;
  if (deepest_behind(field(), beside, hit_.begin, 0).depth > 0) return Vec2(0.0f);
  return over / Vec2(1, volume.aspect);
}

Vec3 ShellCrossing::normal() const { return glm::normalize(frame_.normal + hit_.s * way_.sine * frame_.normal_turn); }

bool ShellCrossing::is_cut() const { return foot_.is_side && way_.begin == 0 && hit_.s == 0; }

/// Normal of the cut, toward the viewer.
Vec3 ShellCrossing::cut_normal() const {
  const float length = glm::length(side_normal_);
  return length > 0 ? side_normal_ / length : normal();
}

/// World-space normal of the structure: the components of its gradient along the texture coordinates and the normal.
Vec3 ShellCrossing::structure_normal(const Vec3& up) const {
  const float aspect = field().volume().aspect;
  const Vec3 slope = field().gradient(hit_.place);
  const TexturePoint texture = scene_.texture(foot_.top);
  const Vec3 n = slope.x * texture.u_gradient + slope.y * aspect * texture.v_gradient + slope.z * frame_.scale * up;
  const float square = glm::dot(n, n);
  return square > 0 ? n / std::sqrt(square) : up;
}

SurfacePoint ShellCrossing::surface(SurfacePoint top, bool shaded) const {
  const VotfVolume& volume = field().volume();
  const Vec3 up = normal(), place = crossing_ + hit_.s * direction_;
  if (!shaded) {
    const float height = leaving_ ? volume.bottom : volume.top;
    top.position = place + up * ((height - hit_.place.z) / frame_.scale);
    top.shading_normal = up;
    return top;
  }
  const Vec3 own = is_cut() ? cut_normal() : structure_normal(up);
  top.position = place + own * (kOffStructure * volume.pitch() / frame_.scale);
  if (!volume.closed) {
    top.geometric_normal = top.shading_normal = own;
    return top;
  }
  // The solid below is not a surface of the ray tracer: light from there does not count, so the normal must not point
  // there.
  const float height = glm::dot(own, leaving_ ? -up : up);
  top.shading_normal = height < 0 ? glm::normalize(own - glm::dot(own, up) * up) : own;
  return top;
}

TexturePoint ShellCrossing::texture(TexturePoint top) const {
  const VotfVolume& volume = field().volume();
  const Vec3 up = normal(), wv = -direction_;
  const float cosine = std::max(glm::dot(wv, up), kMinCosine);
  // Vector from the hit along the ray to the plane of the texels.
  const Vec3 to_plane = (wv - glm::dot(wv, up) * up) * ((volume.reference - hit_.place.z) / (frame_.scale * cosine));
  top.uv = Vec2(hit_.place) / Vec2(1, volume.aspect) +
           Vec2(glm::dot(top.u_gradient, to_plane), glm::dot(top.v_gradient, to_plane));
  return top;
}

}  // namespace velour
