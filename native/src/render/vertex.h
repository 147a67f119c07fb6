// A point of a path, ready to be shaded.
#pragma once

#include "scene/scene.h"
#include "sphere/frame.h"

namespace velour {

class GgxSampler;
class TableSampler;

/// Surfaces are two-sided: both normals are turned to the viewer's side of the geometric surface. Where interpolation
/// leaves the viewer below the shading horizon, the shading normal is bent towards the viewer until wv.z is
/// kLeastCosine: continuous, no division by zero, no black rim. Light from below the geometric surface counts as
/// nothing.
struct Vertex {
  static constexpr float kLeastCosine = 0.01f;

  Vec3 position;
  Vec3 geometric_normal;  // unit, on the viewer's side
  Frame frame;            // shading frame; z on the viewer's side
  Vec3 wv;                // local
  float offset;           // a ray starts this far off the surface, along the geometric normal
  const SurfaceMaterial* surface;
  const TableSampler* table;  // null unless the strategy needs it
  const GgxSampler* ggx;      // the same

  /// `wv_world`: unit, towards the viewer.
  Vertex(const SurfacePoint& point, const Vec3& wv_world);

  Ray ray(const Vec3& direction_world, float far) const {
    return {position + offset * geometric_normal, 0.0f, direction_world, far};
  }
};

}  // namespace velour
