// Rays that go on straight behind a surface.
#pragma once

#include <cmath>

#include "scene/embree_scene.h"

namespace velour {

/// Lets a ray go on behind its hit.
inline void go_beyond(Ray& ray, const Hit& hit) {
  constexpr float kStep = 0x1p-20f;  // of the distance: the ray tracer's own error
  ray.near = std::nextafter(hit.distance * (1.0f + kStep), ray.far);
}

/// A ray crosses a triangle once; what is found again is the same crossing, by rounding.
inline bool same_crossing(const Hit& hit, const Hit& passed) {
  return hit.instance == passed.instance && hit.triangle == passed.triangle;
}

}  // namespace velour
