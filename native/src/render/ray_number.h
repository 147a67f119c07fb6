// Random decisions of a ray at a surface that depend on neither threads nor order.
#pragma once

#include <bit>

#include "scene/embree_scene.h"
#include "sphere/random.h"

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

}  // namespace velour
