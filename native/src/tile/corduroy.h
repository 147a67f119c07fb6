// Corduroy: ribs of pile.
#pragma once

#include "tile/tile.h"

namespace velour {

/// A sheet without holes: ribs along y, parabolas `thickness` high, with flat grooves `gap` wide between them at z = 0.
/// Irregularity makes tufts of unequal height.
TileParts make_corduroy(const TileShape& shape);

}  // namespace velour
