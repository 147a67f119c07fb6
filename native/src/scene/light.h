// Lamps. They are seen by reflected rays, never by the camera.
#pragma once

#include "scene/affine.h"

namespace velour {

/// A lamp shines along its -z: a sun and a spot there alone, a rectangle or a disk from that side only.
struct Light {
  enum class Type : int { sun = 0, point = 1, rectangle = 2, disk = 3, spot = 4 };  // values of velour.h
  Type type = Type::sun;
  Rgb color{
      1.0f};  // sun: irradiance on a plane that faces it, W/m^2; others: power, W; of a spot: were its cone a sphere
  Affine light_to_world;
  Vec2 size{0.0f};        // point, spot: radius, -; rectangle: sides; disk: diameters along x and y
  float angle = 0.0f;     // sun: angular diameter; spot: of its cone; radians
  float blend = 0.0f;     // spot: share of the cone over which it fades out, 0..1
  Vec2 cone_scale{1.0f};  // spot: the cone is so much wider along x and y, as if space were
  bool cosine = false;    // spot: its light also falls with the cosine to the axis, as that of a small plane
  /// Rectangle, disk: full angle in which it shines, radians, as if through a grid of slats: radiance falls off
  /// linearly in the tangent of the angle to the normal, from a value that keeps the power. Pi: the same in all
  /// directions.
  float spread = kPi;
  bool sphere = true;  // point, spot: a ball; false: a disk that faces each place it lights
  bool casts_shadow = true;
};

}  // namespace velour
