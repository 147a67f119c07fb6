// Directions as polar angles in degrees, the convention of measurements.
#pragma once

#include <vector>

#include "sphere/vec.h"

namespace velour {

/// In degrees. `theta`: from the normal of the reference plane, 0..180 (above 90: below the plane); `phi`: from +x
/// towards +y.
struct PolarAngles {
  double theta = 0, phi = 0;
  bool operator==(const PolarAngles&) const = default;
};

/// The unit vector of a direction. All conversions use this function, so that equal angles give equal bits. Multiples
/// of 90 degrees are exact: a direction in the plane has z = 0.
Vec3 unit_direction(const PolarAngles& angles);

/// A ring of `count` directions at `theta`, the first at phi = 0.
std::vector<PolarAngles> ring_directions(double theta, int count);

/// The 81 directions of the Bonn sets (UBO2003): rings of 1, 6, 12, 18, 20, 24 at 0, 15 ... 75 degrees.
std::vector<PolarAngles> bonn_directions();
/// The Bonn directions and a ring of 24 at 85 degrees. Used by captures, because surfaces are seen up to the horizon.
std::vector<PolarAngles> capture_directions();
/// `count` directions of equal solid angle over the upper hemisphere (hemisphere_fibonacci).
std::vector<PolarAngles> even_directions(int count);
/// The mirror images of `directions` below the plane.
std::vector<PolarAngles> below(const std::vector<PolarAngles>& directions);
/// The directions of a set on one side of the plane, in order, as unit vectors mirrored to z > 0.
std::vector<Vec3> directions_on_side(const std::vector<PolarAngles>& set, bool below);

}  // namespace velour
