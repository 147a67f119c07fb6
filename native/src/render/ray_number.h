// Random decisions of a ray at a surface, independent of threads and order.
#pragma once

#include <bit>

#include "scene/embree_scene.h"
#include "sphere/random.h"
#include "sphere/sobol.h"

namespace velour {

enum class RayDecision : uint64_t { alpha = 1, shell_edge };

/// Uniform over [0, 1), hashed from the bits of ray and triangle.
inline float ray_number(const Ray& ray, const Hit& hit, RayDecision decision) {
  uint64_t key = mix64((static_cast<uint64_t>(hit.instance) << 32) + hit.triangle) + static_cast<uint64_t>(decision);
  for (const Vec3& v : {ray.origin, ray.direction}) {
    for (int i = 0; i < 3; ++i) key = mix64(key + std::bit_cast<uint32_t>(v[i]));
  }
  return unit_float(key);
}

/// Source of decisions for one of many related rays, such as the camera rays of a pixel: a key that they share, and the
/// index of the ray.
struct RayDecisions {
  uint64_t key;
  uint32_t index;

  /// Uniform over [0, 1), for the decision that follows `before` others. Stratified over successive rays: of 2^m
  /// aligned rays, one falls into each interval of length 2^-m.
  float number(uint32_t before) const {
    Vec2 u;
    sobol_points(mix64(key + before), index, {&u, 1});
    return u.x;
  }
};

}  // namespace velour
