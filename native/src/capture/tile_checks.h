// What is wrong, or special, about a tile.
#pragma once

#include <optional>
#include <string>

#include "capture/repeated_tile.h"

namespace velour {

/// Whether some vertical ray through the tile, of 4096 spread evenly, meets nothing.
bool is_open(const RepeatedTile& tile);

/// A sentence with numbers where the surface seen from above jumps across the cell's border and hardly anywhere else:
/// the geometry is not periodic, or the period is not its own.
std::optional<std::string> seam_warning(const RepeatedTile& tile);

/// SHA-256 of what the values of the tile depend on: vertices, triangles, places, and what its
/// materials answer for a few directions.
std::string tile_hash(const Scene& scene, const Progress& progress);

}  // namespace velour
