// How much of a surface a ray stands for.
#pragma once

#include "material/surface_site.h"
#include "scene/scene.h"

namespace velour {

/// A ray as wide as what it stands for [Ama84], [AMC21]: metres across at its
/// origin, and what every metre adds.
///
/// Paths widen with their length alone. Mirrors that are flat keep it exact; a rough or bent surface would widen it
/// further, and its textures are then looked up finer than they need be: that costs noise, never a blurred picture.
/// A cone opened by the density of the sampled direction would blur it, and each strategy would converge to a picture
/// of its own.
struct RayCone {
  float width = 0, spread = 0;

  RayCone at(float distance) const { return {width + distance * spread, spread}; }
};

/// Two sides of a parallelogram in world space. What counts is where they lead along the ray, not where they end.
struct RaySides {
  Vec3 x, y;
};

/// A square as wide as the cone, across unit `direction`.
RaySides across(const RayCone& cone, const Vec3& direction);

/// What camera rays stand for: a pixel, or less where it has several. With n camera rays a pixel it is max(1/8,
/// 1/sqrt(n)) of a pixel's side, as in pbrt-v4 [PJH23]: the rays spread over the
/// pixel and average it already, and a texture that averages the whole pixel at each of them would blur the picture a
/// second time. The eighth leaves 1 % of that.
class PixelFootprint {
 public:
  /// `width`, `height` of the picture; `camera_rays` a pixel that the render is asked for, whatever ends it early.
  PixelFootprint(const Scene& scene, int width, int height, int camera_rays);

  /// Of a camera ray along unit `direction`, at the camera: as wide as its pixel's solid angle, or an orthographic
  /// pixel's area, is large. Empty where no material of the
  /// scene varies.
  RayCone cone(const Vec3& direction) const { return needed_ ? cone_along(direction) : RayCone{}; }
  /// Of a camera ray that ends at `position`: exact, by differentials [Ige99].
  RaySides sides(const Vec3& position) const;

 private:
  RayCone cone_along(const Vec3& direction) const;

  const Camera& camera_;
  const bool needed_;
  Vec2 pitch_;  // of what camera rays stand for; metres at distance 1, or anywhere
};

/// In texture coordinates, what `sides` meet along unit `direction` on the plane through the hit. At grazing angles it
/// is stretched no further than kLeastSlope tells. Zero without texture coordinates.
Mat2 texture_footprint(const RaySides& sides, const Vec3& direction, const Vec3& normal, const TexturePoint& texture);

/// Instances of a mesh without texture coordinates of which a material varies: one point of it is shown all over them.
uint64_t untextured_instances(const Scene& scene);

/// Cosine to the geometric normal from which on a footprint grows no longer: a thousand times as long as wide.
inline constexpr float kLeastSlope = 1e-3f;

}  // namespace velour
