// Random decisions of a ray at a surface, which depend on neither threads nor order.
#pragma once

#include <bit>

#include "scene/embree_scene.h"
#include "sphere/random.h"
#include "sphere/sobol.h"

namespace velour {

enum class RayDecision : uint64_t { alpha = 1, shell_edge };

/// Uniform over [0, 1), of the bits of ray and triangle.
inline float ray_number(const Ray& ray, const Hit& hit, RayDecision decision) {
  uint64_t key = mix64((static_cast<uint64_t>(hit.instance) << 32) + hit.triangle) + static_cast<uint64_t>(decision);
  for (const Vec3& v : {ray.origin, ray.direction}) {
    for (int i = 0; i < 3; ++i) key = mix64(key + std::bit_cast<uint32_t>(v[i]));
  }
  return unit_float(key);
}

/// Where a ray takes its decisions from that is one of many, as of a pixel's camera rays: a key that they share, and
/// which of them it is.
struct RayDecisions {
  uint64_t key;
  uint32_t index;

  /// Uniform over [0, 1) at the surface that the ray decides about after `before` others, and even over successive
  /// rays: of 2^m that are aligned, one has each interval of length 2^-m.
  float number(uint32_t before) const {
    Vec2 u;
    sobol_points(mix64(key + before), index, {&u, 1});
    return u.x;
  }
};

}  // namespace velour
