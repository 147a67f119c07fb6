// Bounding boxes of transformed objects.
#pragma once

#include "scene/affine.h"
#include "scene/bounds.h"

namespace velour {

/// World-space box of the transformed corners of `box`; encloses everything in `box`.
inline Bounds box_around(const Bounds& box, const Affine& to_world) {
  Bounds bounds;
  for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
    const Vec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                 corner & 4 ? box.high.z : box.low.z);
    bounds.add(to_world.point(p));
  }
  return bounds;
}

}  // namespace velour
