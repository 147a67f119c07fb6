// One lamp of the scene, ready to be sampled, hit and measured. World space.
#pragma once

#include "scene/light.h"

namespace velour {

class Lamp {
 public:
  /// `scene_radius`: of the sphere that a distant lamp must light; for its power.
  Lamp(const Light& light, float scene_radius);

  /// No extent: no sampled direction can meet it, so it is always lit by name (irradiance()).
  bool sharp() const { return sharp_; }
  bool black() const { return !(power_ > 0.0f); }
  bool casts_shadow() const { return casts_shadow_; }
  /// Luminance of the power that reaches the scene, for choosing between lights.
  float power() const { return power_; }

  /// A lamp with extent: direction from `position` to a random point of it, a zero vector where it cannot be seen.
  Vec3 sample(const Vec3& position, const Vec2& u) const;
  struct Sight {
    float distance = 0;  // infinite for a sun
    float pdf = 0;       // per solid angle, of `sample`; 0: the direction misses the lamp
  };
  Sight hit(const Vec3& position, const Vec3& direction) const;
  /// Constant over the lamp with extent.
  const Rgb& radiance() const { return radiance_; }

  struct Irradiance {
    Vec3 direction;  // to the lamp, unit
    float distance;
    Rgb perpendicular;  // on a plane that faces it
  };
  /// Of a sharp lamp.
  Irradiance irradiance(const Vec3& position) const;

 private:
  void set_sun(const Light& light, float scene_radius);
  void set_point(const Light& light);
  void set_area(const Light& light);
  /// Cone that holds the lamp, seen from `position`: its axis and 1 - cos of its half angle; 0: not seen.
  float cone(const Vec3& position, Vec3& axis) const;

  Light::Type type_;
  bool sharp_ = false, casts_shadow_ = true;
  float power_ = 0;
  Rgb radiance_{0.0f};   // with extent
  Rgb intensity_{0.0f};  // sharp: irradiance of a sun, W/sr of a point
  Vec3 center_{0.0f};    // of a point, rectangle, disk
  Vec3 axis_{0.0f};      // sun: towards it; rectangle, disk: the side that shines
  Vec3 half_x_{0.0f}, half_y_{0.0f};
  float one_minus_cos_ = 0;  // sun
  float radius_ = 0;         // point
  float area_ = 0;
};

}  // namespace velour
