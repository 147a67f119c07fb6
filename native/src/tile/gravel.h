// Pebbles.
#pragma once

#include "tile/packing.h"
#include "tile/tile.h"

namespace velour {

/// Balls (irregularity 0) or stones cut from them, on the floor z = 0, which lets no light through. Thickness is the
/// depth of the bed in pitches, about.
TileParts make_gravel(const TileShape& shape);

/// The balls that the stones are cut from.
std::vector<Ball> gravel_balls(const TileShape& shape);

}  // namespace velour
