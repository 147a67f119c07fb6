// Ribs of pile.
#pragma once

#include "tile/tile.h"

namespace velour {

/// One sheet without a hole: ribs along y, parabolas `thickness` high, with flat grooves `gap` wide
/// between them at z = 0. Irregularity: tufts of unequal height.
TileParts make_corduroy(const TileShape& shape);

}  // namespace velour
