// Lamps. They are seen by reflected rays, never by the camera.
#pragma once

#include "scene/affine.h"

namespace velour {

/// A lamp shines along its -z. Rectangles and disks emit from that side only, with the same radiance in all
/// directions.
struct Light {
  enum class Type : int { sun = 0, point = 1, rectangle = 2, disk = 3 };  // values of velour.h
  Type type = Type::sun;
  Rgb color{1.0f};  // sun: irradiance on a plane that faces it, W/m^2; others: power, W
  Affine light_to_world;
  Vec2 size{0.0f};     // point: radius, -; rectangle: sides; disk: diameters along x and y
  float angle = 0.0f;  // sun: angular diameter, radians
  bool casts_shadow = true;
};

}  // namespace velour
