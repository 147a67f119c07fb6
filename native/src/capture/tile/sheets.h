// Sheets without holes: corduroy and leather.
#pragma once

#include "capture/tile/tile.h"

namespace velour {

/// Ribs of pile along y, parabolas `thickness` high, with flat grooves `gap` wide between them at z = 0. Irregularity
/// makes tufts of unequal height.
TileParts make_corduroy(const TileShape& shape);

/// Grained leather: the cells of a Voronoi diagram of jittered points, one per pitch and side, as cushions `thickness`
/// high, with creases about `gap` wide between them that reach down to z = 0. Irregularity jitters the points and
/// lowers some cushions.
TileParts make_leather(const TileShape& shape);

}  // namespace velour
