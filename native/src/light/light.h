// Lights. Reflected rays see them, camera rays do not.
#pragma once

#include "math/sphere/affine.h"

namespace velour {

/// A light shines along its -z axis: a sun and a spot only in that direction, a rectangle and a disk only from that
/// side. A negative color takes light away.
struct Light {
  enum class Type : int { sun = 0, point = 1, rectangle = 2, disk = 3, spot = 4 };  // values of velour.h
  Type type = Type::sun;
  /// Sun: irradiance on a plane that faces it, W/m^2. Others: power, W; for a spot, as if it shone in all directions.
  Rgb color{1.0f};
  Affine light_to_world;
  Vec2 size{0.0f};        // point, spot: radius (x only); rectangle: sides; disk: diameters along x and y
  float angle = 0.0f;     // sun: angular diameter; spot: full angle of the cone; radians
  float blend = 0.0f;     // spot: fraction of the cone over which it fades out, 0..1
  Vec2 cone_scale{1.0f};  // spot: scale of the cone along x and y
  bool cosine = false;    // spot: intensity also falls with the cosine to the axis, like that of a small plane
  /// Rectangle, disk: full angle in which it shines, radians, as if through a grid of slats: radiance falls off
  /// linearly in the tangent of the angle to the normal, scaled so that the power is kept. Pi: constant radiance in all
  /// directions.
  float spread = kPi;
  bool sphere = true;  // point, spot: a sphere; false: a disk that faces each point that it lights
  bool casts_shadow = true;
  bool is_mirrored = true;  // whether lobes without width (DeltaLobes) show it
  uint8_t hidden_from = 0;  // bits of `hidden` (scene.h): bounces, transmission
};

}  // namespace velour
