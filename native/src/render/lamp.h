// One lamp of the scene, ready to be sampled, hit and measured. World space.
#pragma once

#include "render/light_tree.h"
#include "scene/light.h"

namespace velour {

class Lamp {
 public:
  explicit Lamp(const Light& light);

  /// No extent: no sampled direction can meet it, so it is always lit by name (irradiance()).
  bool sharp() const { return sharp_; }
  bool black() const { return !(intensity() > 0.0f); }
  bool casts_shadow() const { return casts_shadow_; }

  /// For choosing between lamps that are not suns (light_tree.h).
  bool distant() const { return type_ == Light::Type::sun; }
  Bounds bounds() const;
  LightCone cone_of_light() const;
  /// Luminance along the cone's axis, W/sr; of a sun the irradiance on a plane that faces it.
  float intensity() const;
  /// The direction towards a sun.
  const Vec3& axis() const { return axis_; }

  /// A lamp with extent: direction from `position` to a random point of it, a zero vector where it cannot be seen.
  Vec3 sample(const Vec3& position, const Vec2& u) const;
  struct Sight {
    float distance = 0;  // infinite for a sun
    float pdf = 0;       // per solid angle, of `sample`; 0: the direction misses the lamp
  };
  Sight hit(const Vec3& position, const Vec3& direction) const;
  /// Of a lamp with extent, towards where `direction` comes from: unit, to the lamp.
  Rgb radiance(const Vec3& direction) const { return falloff(direction) * radiance_; }

  struct Irradiance {
    Vec3 direction;  // to the lamp, unit
    float distance;
    Rgb perpendicular;  // on a plane that faces it
  };
  /// Of a sharp lamp.
  Irradiance irradiance(const Vec3& position) const;

 private:
  void set_sun(const Light& light);
  void set_point(const Light& light);
  void set_spot(const Light& light);
  void set_area(const Light& light);
  void set_spread(float spread);
  /// Of an area lamp, in units of its half axes about the middle.
  struct Part {
    Vec2 low, high;
    float area;  // square metres
  };
  /// Where it shines to `position` from: a box about that.
  Part part_seen(const Vec3& position) const;
  /// Of where the line through `place` (from the middle) along the normal meets the lamp.
  Vec2 coordinates(const Vec3& place) const;
  /// Whether an area lamp lights `position` along `direction` (to the lamp): from the middle of the lamp on.
  bool shines_on(const Vec3& position, const Vec3& direction) const;
  Vec3 sample_area(const Vec3& position, const Vec2& u) const;
  Sight hit_area(const Vec3& position, const Vec3& direction) const;
  /// Seen as a round cone from wherever.
  bool is_round() const { return type_ != Light::Type::rectangle && type_ != Light::Type::disk; }
  /// Of a spot: cosine to the axis, in space as its cone was before it was scaled.
  float cone_cosine(const Vec3& direction) const;
  /// How much of radiance and intensity goes against `direction`.
  float falloff(const Vec3& direction) const;
  float area_falloff(const Vec3& direction) const;
  /// Cone that holds the lamp, seen from `position`: its axis and 1 - cos of its half angle; 0: not seen.
  float cone(const Vec3& position, Vec3& axis) const;

  Light::Type type_;
  bool sharp_ = false, casts_shadow_ = true, sphere_ = true, cosine_ = false;
  float power_ = 0;      // luminance; of a sun per square metre
  Rgb radiance_{0.0f};   // with extent, less falloff
  Rgb intensity_{0.0f};  // sharp: irradiance of a sun, W/sr of a point
  Vec3 center_{0.0f};    // but for a sun
  Vec3 axis_{0.0f};      // sun: towards it; spot: where it shines; rectangle, disk: unit normal on that side
  Vec3 shine_{0.0f};     // rectangle, disk: where it shines; another direction than axis_ where it is sheared
  Vec3 half_x_{0.0f}, half_y_{0.0f};
  // Spot: rows of the map from world directions to those in which its cone is round, where that is not about axis_.
  Vec3 narrow_x_{0.0f}, narrow_y_{0.0f}, narrow_z_{0.0f};
  float one_minus_cos_ = 0;  // sun
  float radius_ = 0;         // point, spot
  float area_ = 0;
  float cos_cone_ = -1, fade_ = 0;    // spot: cosine where its cone ends, width of the rim in cosines
  float cot_spread_ = 0, focus_ = 1;  // rectangle, disk: cotangent of half the spread, radiance along the normal
};

}  // namespace velour
