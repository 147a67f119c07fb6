// Area of a surface that a ray represents.
#pragma once

#include "material/surface_site.h"
#include "scene/scene.h"

namespace velour {

/// Width of a ray [Ama84], [AMC21]: meters across at its origin, and growth per meter.
///
/// Cones widen with the length of the path alone. Flat mirrors keep them exact; rough or curved surfaces would widen
/// them further, so textures are looked up at a finer level than necessary, which costs noise but never blurs the
/// image. A cone opened by the density of the sampled direction would blur it, and each strategy would converge to a
/// different image.
struct RayCone {
  float width = 0, spread = 0;
  float part = 1;  // its width as a share of a pixel's

  RayCone at(float distance) const { return {width + distance * spread, spread, part}; }
  /// Width of a whole pixel.
  float pixel() const { return width / part; }
};

/// Two sides of a parallelogram in world space. Only their projection along the ray counts.
struct RaySides {
  Vec3 x, y;
};

/// A square as wide as the cone, perpendicular to unit `direction`.
RaySides across(const RayCone& cone, const Vec3& direction);

/// Footprint of camera rays: a pixel, or less with several rays per pixel. With n camera rays per pixel it is max(1/8,
/// 1/sqrt(n)) of a pixel's side, as in pbrt-v4 [PJH23]: the rays already spread over the pixel and average it, and a
/// texture look-up that averages the whole pixel for each of them would blur the image a second time. At an eighth, 1 %
/// of that remains.
class PixelFootprint {
 public:
  /// `width`, `height`: of the image; `camera_rays`: requested per pixel, even if the render ends early.
  PixelFootprint(const Scene& scene, int width, int height, int camera_rays);

  /// Cone of a camera ray along unit `direction`, at the camera: as wide as its pixel's solid angle, or an orthographic
  /// pixel's area. Empty if no material of the scene varies.
  RayCone cone(const Vec3& direction, float time = kMiddleTime) const {
    return needed_ ? cone_along(direction, time) : RayCone{};
  }
  /// Sides for a camera ray that ends at `position`: exact, by ray differentials [Ige99].
  RaySides sides(const Vec3& position, float time = kMiddleTime) const;

 private:
  RayCone cone_along(const Vec3& direction, float time) const;

  const Camera& camera_;
  const bool needed_;
  float part_;  // of a pixel's side
  Vec2 pitch_;  // size of the footprint of camera rays; meters at distance 1, or anywhere (orthographic)
};

/// Footprint in texture coordinates: `sides` projected along unit `direction` onto the plane through the hit. At
/// grazing angles its stretch is limited by kMinSlope. Zero without texture coordinates.
Mat2 texture_footprint(const RaySides& sides, const Vec3& direction, const Vec3& normal, const TexturePoint& texture);

/// Number of instances with a varying material on a mesh without texture coordinates, which show a single point of the
/// material everywhere.
uint64_t untextured_instances(const Scene& scene);

/// Minimum cosine to the geometric normal in footprints, which are thus at most a thousand times as long as wide.
inline constexpr float kMinSlope = 1e-3f;

}  // namespace velour
