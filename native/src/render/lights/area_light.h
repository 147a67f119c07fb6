// A light of the scene, ready for sampling, hit tests and evaluation. World space.
#pragma once

#include "light/light.h"
#include "render/lights/light_tree.h"

namespace velour {

class Lamp {
 public:
  explicit Lamp(const Light& light);

  /// Whether this is a delta light: no sampled direction can hit it, so it is always evaluated by irradiance().
  bool sharp() const { return sharp_; }
  bool black() const { return !(intensity() > 0.0f); }
  bool casts_shadow() const { return casts_shadow_; }
  bool is_mirrored() const { return is_mirrored_; }
  /// `kind`: a bit of `hidden`.
  bool is_hidden(uint8_t kind) const { return (hidden_from_ & kind) != 0; }

  /// For the choice among lights that are not suns (light_tree.h).
  bool distant() const { return type_ == Light::Type::sun; }
  Bounds bounds() const;
  LightCone cone_of_light() const;
  /// Absolute luminance along the cone's axis, W/sr; for a sun, the irradiance on a plane that faces it.
  float intensity() const;
  /// Direction toward a sun.
  const Vec3& axis() const { return axis_; }

  /// For a light with extent: direction from `position` to a random point of it; a zero vector if it is not visible.
  Vec3 sample(const Vec3& position, const Vec2& u) const;
  struct Sight {
    float distance = 0;  // infinite for a sun
    float pdf = 0;       // per solid angle, of `sample`; 0: the direction misses the light
  };
  Sight hit(const Vec3& position, const Vec3& direction) const;
  /// Radiance that a light with extent emits against `direction`: unit, to the light.
  Rgb radiance(const Vec3& direction) const { return falloff(direction) * radiance_; }

  struct Irradiance {
    Vec3 direction;  // unit, toward the light
    float distance;
    Rgb perpendicular;  // on a plane that faces it
  };
  /// Irradiance from a delta light.
  Irradiance irradiance(const Vec3& position) const;

 private:
  void set_sun(const Light& light);
  void set_point(const Light& light);
  void set_spot(const Light& light);
  void set_area(const Light& light);
  void set_spread(float spread);
  /// Part of an area light, in units of its half axes about the center.
  struct Part {
    Vec2 low, high;
    float area;  // square meters
  };
  /// Bounding box of the part that shines toward `position`.
  Part part_seen(const Vec3& position) const;
  /// Coordinates of the point where the line through `place` (relative to the center) along the normal meets the light.
  Vec2 coordinates(const Vec3& place) const;
  /// Whether an area light illuminates `position` along `direction` (to the light): only in front of its center.
  bool shines_on(const Vec3& position, const Vec3& direction) const;
  /// How far sample_area() may miss an area light by rounding, in units of its half axes; 0 where that is negligible.
  Vec2 slack_at(float distance) const;
  Vec3 sample_area(const Vec3& position, const Vec2& u) const;
  Sight hit_area(const Vec3& position, const Vec3& direction) const;
  /// Whether the light looks like a circular cone from every position.
  bool is_round() const { return type_ != Light::Type::rectangle && type_ != Light::Type::disk; }
  /// Spot: cosine to the axis, in the space of its cone before scaling.
  float cone_cosine(const Vec3& direction) const;
  /// Share of radiance or intensity that is emitted against `direction`.
  float falloff(const Vec3& direction) const;
  float area_falloff(const Vec3& direction) const;
  /// Cone that contains the light as seen from `position`: its axis and 1 - cos of its half angle; 0: not visible.
  float cone(const Vec3& position, Vec3& axis) const;

  Light::Type type_;
  bool sharp_ = false, casts_shadow_ = true, is_mirrored_ = true, sphere_ = true, cosine_ = false;
  uint8_t hidden_from_ = 0;
  float power_ = 0;      // absolute luminance; for a sun, per square meter
  Rgb radiance_{0.0f};   // lights with extent, before falloff
  Rgb intensity_{0.0f};  // delta lights: irradiance of a sun, W/sr of a point
  Vec3 center_{0.0f};    // not for suns
  Vec3 axis_{0.0f};      // sun: toward it; spot: direction of emission; rectangle, disk: unit normal on that side
  Vec3 shine_{0.0f};     // rectangle, disk: direction of emission; differs from axis_ if sheared
  Vec3 half_x_{0.0f}, half_y_{0.0f};
  Vec2 inverse_halves_{0.0f};  // one over their lengths
  // Spot: rows of the map from world directions to those in which its cone is circular, if not circular about axis_.
  Vec3 narrow_x_{0.0f}, narrow_y_{0.0f}, narrow_z_{0.0f};
  float one_minus_cos_ = 0;  // sun
  float radius_ = 0;         // point, spot
  float area_ = 0;
  float cos_cone_ = -1, fade_ = 0;    // spot: cosine at the edge of its cone, width of the blend in cosines
  float cot_spread_ = 0, focus_ = 1;  // rectangle, disk: cotangent of half the spread, radiance along the normal
};

}  // namespace velour
