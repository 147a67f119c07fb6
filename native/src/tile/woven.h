// Tiles of two sets of yarns that cross at right angles.
//
// Every section of a yarn across its direction is an upright ellipse of half-axes a (sideways) and b (up); only its
// middle moves, along z. So a yarn's shadow on the cloth is a straight strip, and the share of open area is exactly
// (gap / pitch)^2. At a crossing the middle of the upper yarn stands at least b sqrt(1 - (d / a)^2) above the cloth's
// middle plane at distance d from the crossing, and the lower yarn as far below: which is when the two do not meet.
#pragma once

#include "tile/tile.h"

namespace velour {

/// Height of a yarn's middle between a crossing that it passes above, at u = 0, and one that it passes below, at u = 1,
/// as a share of its height at a crossing: c (3 - c^2) / 2 of c = cos(pi u). Slope and curvature vanish at both ends,
/// so that it goes on straight over a float.
double yarn_wave(double u);

/// Height of a yarn's middle at a crossing, in half-heights of the yarn: the least, and at least 1, that keeps yarns of
/// half-width `half_width` (pitches, below 0.5) apart.
double yarn_amplitude(double half_width);

TileParts make_weave(const TileShape& shape);
TileParts make_twill(const TileShape& shape);
/// Cords of the same make; wide apart.
TileParts make_net(const TileShape& shape);

}  // namespace velour
