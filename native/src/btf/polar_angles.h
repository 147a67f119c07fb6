// Directions as measurements name them: by their angles in degrees.
#pragma once

#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Degrees. `theta` from the normal of the reference plane, 0..180 (beyond 90: from below the plane); `phi` from +x
/// towards +y.
struct PolarAngles {
  double theta = 0, phi = 0;
  bool operator==(const PolarAngles&) const = default;
};

/// The unit vector; the only way from angles to vectors, so that the same angles give the same bits everywhere.
/// Multiples of 90 degrees are exact: a direction in the plane has z = 0.
Vec3 unit_direction(const PolarAngles& angles);

/// A ring of `count` directions at `theta`, the first at phi = 0.
std::vector<PolarAngles> ring_directions(double theta, int count);

/// The 81 directions of the Bonn sets (UBO2003): rings of 1, 6, 12, 18, 20, 24 at 0, 15 ... 75 degrees.
std::vector<PolarAngles> bonn_directions();
/// The same and a ring of 24 at 85 degrees: what captures use, because surfaces are seen to the horizon.
std::vector<PolarAngles> capture_directions();
/// `count` directions of equal solid angle over the upper hemisphere (hemisphere_fibonacci).
std::vector<PolarAngles> even_directions(int count);
/// The mirror images of `directions` below the plane.
std::vector<PolarAngles> below(const std::vector<PolarAngles>& directions);
/// Those of a set that lie on one side of the plane, in its order, as unit vectors mirrored to z > 0.
std::vector<Vec3> directions_on_side(const std::vector<PolarAngles>& set, bool below);

}  // namespace velour
