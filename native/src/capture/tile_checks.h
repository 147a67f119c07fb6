// Checks of a tile: whether it is open and periodic, and its hash.
#pragma once

#include <optional>
#include <string>

#include "capture/repeated_tile.h"

namespace velour {

/// Whether any of 4096 evenly distributed vertical rays through the tile hits nothing.
bool is_open(const RepeatedTile& tile);

/// Warning with numbers if the surface seen from above jumps across the cell's border and hardly anywhere else: the
/// geometry is not periodic, or the period is wrong.
std::optional<std::string> seam_warning(const RepeatedTile& tile);

/// SHA-256 of everything the values of the tile depend on: vertices, triangles, transforms, and f of its materials for
/// a few pairs of directions.
std::string tile_hash(const Scene& scene, const Progress& progress);

}  // namespace velour
