// Cameras.
#pragma once

#include "scene/affine.h"
#include "scene/bounds.h"
#include "scene/embree_scene.h"

namespace velour {

/// The opening of a thin lens, in the plane of the camera's origin.
struct Aperture {
  float radius = 0.0f;    // metres; 0: a pinhole, and all is sharp
  float focus = 1.0f;     // metres along -z to the plane that is sharp; positive
  int blades = 0;         // sides of the polygon whose corners lie on the circle; below 3: the circle itself
  float rotation = 0.0f;  // of the polygon, counter-clockwise as the camera sees it, radians
  float ratio = 1.0f;     // height over width of the opening: an anamorphic lens is narrower than high

  /// A place of it, uniform for uniform `u`; metres.
  Vec2 sample(const Vec2& u) const;
};

/// Looks along its -z with +y up.
struct Camera {
  enum class Type : int { perspective = 0, orthographic = 1 };  // values of velour.h
  Type type = Type::perspective;
  Affine camera_to_world;                        // axes of length 1, else any: mirrored, sheared
  float window[4] = {-0.5f, 0.5f, -0.5f, 0.5f};  // left, right, bottom, top; at distance 1, or in metres
  float clip_start = 0.0f, clip_end = std::numeric_limits<float>::infinity();  // along -z

  Aperture aperture;

  /// Ray through `picture`, (0, 0) the lower left corner of the picture and (1, 1) the upper right, and through the
  /// place `lens` of the aperture, metres. World, unit.
  Ray ray(const Vec2& picture, const Vec2& lens = Vec2(0.0f)) const;
  /// Distance of `world` from the camera along its line of sight: what a depth pass holds. As if there were no shear.
  float depth(const Vec3& world) const;

  /// Perspective camera at `eye`; `fov` is the vertical angle of view, `aspect` width / height. Up is world `up`.
  static Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov, float aspect);
  /// Frames `bounds` to the picture (its height, unless the box is wider than the picture), with a vertical angle of
  /// view of 40 degrees. `up_axis` 2: up is +z, seen along +y (Blender's front view); 1: up is +y, seen along -z.
  static Camera framing(const Bounds& bounds, float aspect, int up_axis);
};

}  // namespace velour
