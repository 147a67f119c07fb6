// Rays that continue straight behind a surface.
#pragma once

#include <cmath>

#include "scene/embree_scene.h"

namespace velour {

/// Makes a ray start behind its hit.
inline void go_beyond(Ray& ray, const Hit& hit) {
  constexpr float kStep = 0x1p-20f;  // relative to the distance: the error of the ray tracer
  ray.near = std::nextafter(hit.distance * (1.0f + kStep), ray.far);
}

/// A ray crosses a triangle only once: a second hit is the same crossing, found again through rounding.
inline bool same_crossing(const Hit& hit, const Hit& passed) {
  return hit.instance == passed.instance && hit.triangle == passed.triangle;
}

}  // namespace velour
