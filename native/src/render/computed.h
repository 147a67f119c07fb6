// Values that a material's program computes at a hit.
#pragma once

#include "material/surface_site.h"
#include "scene/scene.h"

namespace velour {

class Program;

/// A hit at which a program is evaluated.
struct ComputedPlace {
  const Scene& scene;
  const Hit& hit;
  const SurfacePoint& point;  // of the hit
  Vec3 incoming;              // unit, towards the viewer, world space
  float step = 0;             // width of a pixel in meters, for bump; 0: small

  bool is_back() const { return glm::dot(point.geometric_normal, incoming) < 0.0f; }
};

/// Fills site.computed. Normals are unit and in world space. Images are averaged over the footprints of `site`.
void compute(const Program& program, const ComputedPlace& place, SurfaceSite& site);

}  // namespace velour
