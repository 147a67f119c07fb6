// Woven tiles: two sets of yarns that cross at right angles.
//
// Every cross section of a yarn is an upright ellipse with half-axes a (sideways) and b (up); only its center moves,
// along z. A yarn's shadow on the cloth is therefore a straight strip, and the share of open area is exactly (gap /
// pitch)^2. At distance d from a crossing, the center of the upper yarn is at least b sqrt(1 - (d / a)^2) above the
// middle plane of the cloth, and the lower yarn as far below: the condition for the two not to intersect.
#pragma once

#include "capture/tile/tile.h"

namespace velour {

/// Height of a yarn's center between a crossing that it passes above, at u = 0, and one that it passes below, at u = 1,
/// as a share of its height at a crossing: c (3 - c^2) / 2 with c = cos(pi u). Slope and curvature vanish at both ends,
/// so that the yarn continues straight over a float.
double yarn_wave(double u);

/// Height of a yarn's center at a crossing, in half-heights of the yarn: the minimum, and at least 1, that keeps yarns
/// of half-width `half_width` (pitches, below 0.5) apart.
double yarn_amplitude(double half_width);

TileParts make_weave(const TileShape& shape);
TileParts make_twill(const TileShape& shape);
/// Five-end satin: the warp floats over four wefts, so that it covers the face.
TileParts make_satin(const TileShape& shape);
/// The plain weave, with cords far apart.
TileParts make_net(const TileShape& shape);

}  // namespace velour
