// Gravel: a bed of pebbles.
#pragma once

#include "tile/packing.h"
#include "tile/tile.h"

namespace velour {

/// Balls (irregularity 0) or stones cut from them, on the opaque floor z = 0. Thickness is the approximate depth of the
/// bed in pitches.
TileParts make_gravel(const TileShape& shape);

/// The balls that the stones are cut from.
std::vector<Ball> gravel_balls(const TileShape& shape);

}  // namespace velour
