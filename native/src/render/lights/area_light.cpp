#include "render/lights/area_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/sphere/frame.h"
#include "math/sphere/warp.h"

namespace velour {
namespace {

/// 1 - cos of an angle from its squared sine, without cancellation.
float one_minus_cos(float sin_sq) { return sin_sq / (1.0f + std::sqrt(std::max(0.0f, 1.0f - sin_sq))); }

Vec3 sample_cone(const Vec3& axis, float extent, const Vec2& u) {
  const float drop = u.x * extent;  // 1 - cos
  const float r = std::sqrt(drop * (2.0f - drop));
  const float phi = 2.0f * kPi * u.y;
  return Frame::about(axis).to_world({r * std::cos(phi), r * std::sin(phi), 1.0f - drop});
}

float pdf_cone(float extent) { return 1.0f / (2.0f * kPi * extent); }

/// 1 - cos between unit vectors, without cancellation.
float drop_between(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return 0.5f * glm::dot(d, d);
}

/// Maximum 1 - cos from the axis at which a direction counts as inside a cone of `extent`. Direction components are
/// rounded, which moves samples by up to 5e-8 (measured): for a cone of sine 1e-5 one in a thousand falls outside, for
/// 1e-7 one in ten. Cones that narrow therefore reach beyond their rims by twice as much; no other samples hit them.
float reach(float extent) {
  constexpr float kNarrow = 5e-11f, kRounding = 1e-7f;
  if (extent >= kNarrow || !(extent > 0.0f)) return extent;
  const float chord = std::sqrt(2.0f * extent) + kRounding;
  return 0.5f * chord * chord;
}

float smooth_step(float t) { return t * t * (3.0f - 2.0f * t); }

}  // namespace

Lamp::Lamp(const Light& light)
    : type_(light.type),
      casts_shadow_(light.casts_shadow),
      is_mirrored_(light.is_mirrored),
      sphere_(light.sphere),
      hidden_from_(light.hidden_from) {
  switch (type_) {
    case Light::Type::sun:
      set_sun(light);
      break;
    case Light::Type::point:
      set_point(light);
      break;
    case Light::Type::spot:
      set_point(light);
      set_spot(light);
      break;
    case Light::Type::rectangle:
    case Light::Type::disk:
      set_area(light);
      break;
  }
}

void Lamp::set_sun(const Light& light) {
  axis_ = light.light_to_world.column(2);
  if (!(glm::length(axis_) > 0.0f)) return;  // scaled to nothing: black
  axis_ = glm::normalize(axis_);
  power_ = luminance(glm::abs(light.color));
  const float sine = std::sin(0.5f * std::clamp(light.angle, 0.0f, kPi));
  sharp_ = !(sine > 1e-5f);  // two arc seconds: below what float32 directions resolve
  if (sharp_) {
    intensity_ = light.color;
    return;
  }
  one_minus_cos_ = one_minus_cos(sine * sine);
  // A facing plane gathers L pi sin^2 from a cone of constant radiance L.
  radiance_ = light.color / (kPi * sine * sine);
}

void Lamp::set_point(const Light& light) {
  center_ = light.light_to_world.column(3);
  radius_ = std::max(light.size.x, 0.0f);
  power_ = luminance(glm::abs(light.color));
  sharp_ = !(radius_ > 1e-12f);  // whose square is no normal number
  if (sharp_) {
    intensity_ = light.color / (4.0f * kPi);
  } else {
    radiance_ = light.color / (4.0f * kPi * kPi * radius_ * radius_);
  }
}

void Lamp::set_spot(const Light& light) {
  axis_ = -glm::normalize(light.light_to_world.column(2));
  cos_cone_ = std::cos(0.5f * std::clamp(light.angle, 0.0f, 2.0f * kPi));
  cosine_ = light.cosine;
  const Affine& map = light.light_to_world;
  const Mat3 axes(map.column(0), map.column(1), map.column(2));
  const Mat3 products = glm::transpose(axes) * axes;
  constexpr float kPerpendicular = 1e-5f;
  const bool sheared =
      std::max({std::abs(products[0][1]), std::abs(products[0][2]), std::abs(products[1][2])}) > kPerpendicular;
  // Before Blender 3.5, whose spots also fall off with the cosine, the cone stayed circular whatever its axes were.
  const bool turns_with_axes = sheared && !cosine_ && std::abs(glm::determinant(axes)) > kPerpendicular;
  if (light.cone_scale != Vec2(1.0f) || turns_with_axes) {
    const Mat3 rows = turns_with_axes ? glm::transpose(glm::inverse(axes)) : axes;
    narrow_x_ = rows[0] / light.cone_scale.x;
    narrow_y_ = rows[1] / light.cone_scale.y;
    narrow_z_ = -rows[2];
  }
  fade_ = std::clamp(light.blend, 0.0f, 1.0f) * (1.0f - cos_cone_);
}

void Lamp::set_area(const Light& light) {
  const Affine& map = light.light_to_world;
  center_ = map.column(3);
  half_x_ = 0.5f * light.size.x * map.column(0);
  half_y_ = 0.5f * light.size.y * map.column(1);
  const Vec3 normal = glm::cross(half_x_, half_y_);
  const float quarter = glm::length(normal);
  area_ = quarter * (type_ == Light::Type::disk ? kPi : 4.0f);
  if (!(area_ > 0.0f)) return;  // without extent it emits nothing: power stays 0
  inverse_halves_ = 1.0f / Vec2(glm::length(half_x_), glm::length(half_y_));
  axis_ = normal / quarter;
  if (glm::dot(axis_, map.column(2)) > 0.0f) axis_ = -axis_;
  constexpr float kStraight = 1e-6f;  // 1 - cosine
  const float length = glm::length(map.column(2));
  shine_ = length > 0.0f ? -map.column(2) / length : axis_;
  if (drop_between(shine_, axis_) < kStraight) shine_ = axis_;
  power_ = luminance(glm::abs(light.color));
  radiance_ = light.color / (kPi * area_);
  if (type_ == Light::Type::rectangle) radiance_ *= quarter / (glm::length(half_x_) * glm::length(half_y_));
  set_spread(light.spread);
}

/// The integral of (1 - cot(h) tan(x)) cos(x) over the directions within h of the normal is pi (1 - h cot(h)).
void Lamp::set_spread(float spread) {
  constexpr float kLeast = 0.5f * kPi / 180.0f;  // as in Blender: one degree in total
  const float half = std::clamp(0.5f * spread, kLeast, 0.5f * kPi);
  if (half == 0.5f * kPi) return;
  cot_spread_ = 1.0f / std::tan(half);
  focus_ = 1.0f / (1.0f - half * cot_spread_);
}

Bounds Lamp::bounds() const {
  const Vec3 extent = is_round() ? Vec3(radius_) : glm::abs(half_x_) + glm::abs(half_y_);
  return {center_ - extent, center_ + extent};
}

LightCone Lamp::cone_of_light() const {
  switch (type_) {
    case Light::Type::sun:
    case Light::Type::point:
      break;
    case Light::Type::spot:
      // The directions of a scaled cone are not bounded here.
      if (narrow_z_ == Vec3(0.0f)) return {axis_, cos_cone_, std::cos(0.1f)};
      break;
    case Light::Type::rectangle:
    case Light::Type::disk:
      return {shine_, std::clamp(glm::dot(shine_, axis_), -1.0f, 1.0f),
              cot_spread_ > 0.0f ? cot_spread_ / std::sqrt(1.0f + cot_spread_ * cot_spread_) : 0.0f};
  }
  return {};
}

float Lamp::intensity() const {
  if (distant()) return power_;
  return power_ / (is_round() ? 4.0f * kPi : kPi) * focus_;
}

float Lamp::cone_cosine(const Vec3& direction) const {
  if (narrow_z_ == Vec3(0.0f)) return -glm::dot(direction, axis_);
  const float cosine = -glm::dot(direction, narrow_z_);
  return cosine / glm::length(Vec3(glm::dot(direction, narrow_x_), glm::dot(direction, narrow_y_), cosine));
}

/// Sheared lights behave as in Cycles, which weights samples of a disk by the cosine to the light's own axis instead of
/// the normal of its plane, and samples rectangles by solid angle.
float Lamp::area_falloff(const Vec3& direction) const {
  constexpr float kMaxRatio = 1e4f;  // viewed along the plane
  const float cosine = -glm::dot(direction, shine_);
  if (!(cosine > 0.0f)) return cot_spread_ == 0.0f && type_ == Light::Type::rectangle ? 1.0f : 0.0f;
  const float lean = std::abs(glm::dot(direction, axis_));
  const bool leans = shine_ != axis_ && type_ == Light::Type::disk;
  const float ratio = !leans ? 1.0f : (cosine < kMaxRatio * lean ? cosine / lean : kMaxRatio);
  if (cot_spread_ == 0.0f) return ratio;
  const float tangent = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
  return ratio * focus_ * std::max(0.0f, 1.0f - cot_spread_ * tangent);
}

float Lamp::falloff(const Vec3& direction) const {
  if (type_ == Light::Type::rectangle || type_ == Light::Type::disk) return area_falloff(direction);
  if (type_ != Light::Type::spot) return 1.0f;
  const float cosine = cone_cosine(direction);
  if (cosine <= cos_cone_) return 0.0f;
  const float t = cosine - cos_cone_;
  return (t < fade_ ? smooth_step(t / fade_) : 1.0f) * (cosine_ ? cosine : 1.0f);
}

float Lamp::cone(const Vec3& position, Vec3& axis) const {
  if (type_ == Light::Type::sun) {
    axis = axis_;
    return one_minus_cos_;
  }
  const Vec3 to_center = center_ - position;
  const float distance_sq = glm::dot(to_center, to_center);
  const float radius_sq = radius_ * radius_;
  // A ball emits outward, so it is dark from inside. A disk cannot be seen from its center.
  if (!(distance_sq > (sphere_ ? radius_sq : 0.0f))) return 0.0f;
  axis = to_center / std::sqrt(distance_sq);
  return one_minus_cos(radius_sq / (sphere_ ? distance_sq : distance_sq + radius_sq));
}

Vec3 Lamp::sample(const Vec3& position, const Vec2& u) const {
  if (is_round()) {
    Vec3 axis;
    const float extent = cone(position, axis);
    return extent > 0.0f ? sample_cone(axis, extent, u) : Vec3(0.0f);
  }
  return sample_area(position, u);
}

Lamp::Sight Lamp::hit(const Vec3& position, const Vec3& direction) const {
  if (is_round()) {
    Vec3 axis(0.0f);
    const float extent = cone(position, axis);
    const float drop = drop_between(direction, axis);
    if (!(extent > 0.0f) || drop > reach(extent)) return {};
    if (type_ == Light::Type::sun) return {std::numeric_limits<float>::infinity(), pdf_cone(extent)};
    const float distance = glm::length(center_ - position);
    if (!sphere_) return {distance / (1.0f - drop), pdf_cone(extent)};
    const float across_sq = distance * distance * drop * (2.0f - drop);
    const float near_side = std::sqrt(std::max(0.0f, radius_ * radius_ - across_sq));
    return {distance * (1.0f - drop) - near_side, pdf_cone(extent)};
  }
  return hit_area(position, direction);
}

Vec2 Lamp::coordinates(const Vec3& place) const {
  // The half axes of a sheared light are not perpendicular.
  const Vec3 normal = glm::cross(half_x_, half_y_);
  const Vec2 scaled(glm::dot(glm::cross(place, half_y_), normal), glm::dot(glm::cross(half_x_, place), normal));
  return scaled / glm::dot(normal, normal);
}

Lamp::Part Lamp::part_seen(const Vec3& position) const {
  if (cot_spread_ == 0.0f) return {Vec2(-1.0f), Vec2(1.0f), area_};
  const Vec3 place = position - center_;
  const float quarter = glm::length(glm::cross(half_x_, half_y_));
  if (shine_ != axis_) return {Vec2(-1.0f), Vec2(1.0f), 4.0f * quarter};
  const float radius = std::max(0.0f, glm::dot(place, axis_)) / cot_spread_;  // circle that shines on `position`
  const Vec2 middle = coordinates(place), extent = radius / quarter * Vec2(glm::length(half_y_), glm::length(half_x_));
  const Vec2 low = glm::max(middle - extent, Vec2(-1.0f)), high = glm::min(middle + extent, Vec2(1.0f));
  const Vec2 size = glm::max(high - low, Vec2(0.0f));
  return {low, high, quarter * size.x * size.y};
}

bool Lamp::shines_on(const Vec3& position, const Vec3& direction) const {
  if (!(glm::dot(position - center_, shine_) > 0.0f)) return false;
  return type_ == Light::Type::rectangle || glm::dot(direction, shine_) < 0.0f;
}

Vec3 Lamp::sample_area(const Vec3& position, const Vec2& u) const {
  const bool disk = type_ == Light::Type::disk;
  const Part part = part_seen(position);
  if (!(part.area > 0.0f)) return Vec3(0.0f);
  const Vec2 place = disk && cot_spread_ == 0.0f ? sample_uniform_disk(u) : glm::mix(part.low, part.high, u);
  if (disk && glm::dot(place, place) > 1.0f) return Vec3(0.0f);
  // Differences first: far from the origin, sums of positions lose the digits of small lights.
  const Vec3 to_lamp = (center_ - position) + place.x * half_x_ + place.y * half_y_;
  return shines_on(position, to_lamp) ? glm::normalize(to_lamp) : Vec3(0.0f);
}

Vec2 Lamp::slack_at(float distance) const {
  constexpr float kRounding = 4e-7f;  // of a unit direction
  constexpr float kMinSlack = 1e-4f;
  const Vec2 slack = kRounding * distance * inverse_halves_;
  return {slack.x < kMinSlack ? 0.0f : slack.x, slack.y < kMinSlack ? 0.0f : slack.y};
}

Lamp::Sight Lamp::hit_area(const Vec3& position, const Vec3& direction) const {
  const float facing = -glm::dot(direction, axis_);
  const float height = glm::dot(position - center_, axis_);
  const float distance = height / facing;
  if (!shines_on(position, direction) || !(distance > 0.0f) || !std::isfinite(distance)) return {};
  const Vec2 place = coordinates((position - center_) + distance * direction);
  const Part part = part_seen(position);
  const Vec2 slack = slack_at(distance);
  const bool inside =
      glm::all(glm::lessThanEqual(part.low - slack, place)) && glm::all(glm::lessThanEqual(place, part.high + slack));
  const Vec2 round = place / (1.0f + slack);
  if (!inside || (type_ == Light::Type::disk && glm::dot(round, round) > 1.0f) || !(part.area > 0.0f)) return {};
  return {distance, distance * distance / (std::abs(facing) * part.area)};
}

Lamp::Irradiance Lamp::irradiance(const Vec3& position) const {
  if (type_ == Light::Type::sun) return {axis_, std::numeric_limits<float>::infinity(), intensity_};
  const Vec3 to_lamp = center_ - position;
  const float distance_sq = std::max(glm::dot(to_lamp, to_lamp), 1e-30f);
  const float distance = std::sqrt(distance_sq);
  const Vec3 direction = to_lamp / distance;
  return {direction, distance, falloff(direction) * intensity_ / distance_sq};
}

}  // namespace velour
