// Cameras and their shutters.
#pragma once

#include <array>
#include <optional>
#include <vector>
#include "math/sphere/affine.h"
#include "scene/embree_scene.h"
#include "scene/motion.h"

namespace velour {

// Times of camera rays.

/// Distribution of times over [0, 1], while the shutter is open: in proportion to how far it is open.
class Shutter {
 public:
  /// `opening`: at even times from 0 to 1, linear in between; a single value: constant. Throws Error(invalid_argument)
  /// unless all values are finite and at least 0, and one is above 0.
  explicit Shutter(const std::vector<float>& opening = {1.0f});

  /// Inverse of the distribution function; `u` in [0, 1).
  float time(float u) const;
  /// Density of time().
  float density(float time) const;

 private:
  std::vector<float> density_;  // at even times; at least two
  std::vector<float> below_;    // distribution function there
};

/// Aperture of a thin lens, in the plane of the camera's origin.
struct Aperture {
  float radius = 0.0f;    // meters; 0: a pinhole, everything is in focus
  float focus = 1.0f;     // focus distance along -z in meters; positive
  int blades = 0;         // sides of the polygon inscribed in the circle; below 3: the circle itself
  float rotation = 0.0f;  // of the polygon, counterclockwise as seen by the camera, radians
  float ratio = 1.0f;     // height over width of the aperture; above 1 for anamorphic lenses

  /// Point on the aperture in meters, uniformly distributed for uniform `u`.
  Vec2 sample(const Vec2& u) const;
};

/// Looks along its -z axis with +y up.
struct Camera {
  enum class Type : int { perspective = 0, orthographic = 1 };  // values of velour.h
  Type type = Type::perspective;
  Affine camera_to_world;                        // axes of length 1; may mirror and shear
  float window[4] = {-0.5f, 0.5f, -0.5f, 0.5f};  // left, right, bottom, top; at distance 1, or meters (orthographic)
  float clip_start = 0.0f, clip_end = std::numeric_limits<float>::infinity();  // along -z

  Aperture aperture;

  /// Where the camera is at even times while its shutter is open, linear in between; camera_to_world and window are
  /// those of the middle. Empty: it does not move, or does not zoom.
  std::vector<Affine> steps = {};
  std::vector<std::array<float, 4>> windows = {};
  /// Empty: the shutter opens for an instant in the middle, and nothing blurs.
  std::optional<Shutter> shutter = std::nullopt;

  Affine place(float time) const { return steps.empty() ? camera_to_world : interpolated(steps, time); }
  std::array<float, 4> window_at(float time) const;

  /// World-space ray with unit direction through the point `picture`, from (0, 0) at the lower left corner of the
  /// picture to (1, 1) at the upper right, and the point `lens` of the aperture, in meters.
  Ray ray(const Vec2& picture, const Vec2& lens = Vec2(0.0f), float time = kMiddleTime) const;
  /// Distance of `world` from the camera along its line of sight, as in a depth pass. Ignores shear.
  float depth(const Vec3& world, float time = kMiddleTime) const;

  /// Perspective camera at `eye`. `fov`: vertical angle of view, radians; `aspect`: width / height; `up`: world space.
  static Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov, float aspect);
  /// Fits `bounds` into the picture (by height, unless the box is wider than the picture), with a vertical angle of
  /// view of 40 degrees. `up_axis` 2: +z is up, viewed along +y (Blender's front view); 1: +y is up, viewed along -z.
  static Camera framing(const Bounds& bounds, float aspect, int up_axis);
};

/// Where a camera shows points at a time: the inverse of Camera::ray() through the center of the lens.
class CameraProjection {
 public:
  CameraProjection(const Camera& camera, float time)
      : type_(camera.type), to_camera_(camera.place(time).inverse()), window_(camera.window_at(time)) {}

  /// Point of the picture, as in Camera::ray().
  Vec2 picture(const Vec3& world) const;

 private:
  Camera::Type type_;
  Affine to_camera_;
  std::array<float, 4> window_;
};

}  // namespace velour
