// Checks of a tile: whether it is open and periodic, and its hash.
#pragma once

#include <optional>
#include <string>
#include "base/progress.h"
#include "base/warning.h"
#include "capture/btf/repeated_tile.h"

namespace velour {

/// Whether any of 4096 evenly distributed vertical rays through the tile hits nothing.
bool is_open(const RepeatedTile& tile);

/// Warning if the surface seen from above jumps across the cell's border and hardly anywhere else: the
/// geometry is not periodic, or the period is wrong.
std::optional<Warning> seam_warning(const RepeatedTile& tile);

// The height of the reference plane.

/// The height (scene's z) at which texels look most alike from all sides: of kReferenceHeights heights, evenly spaced
/// from bottom to top, the one whose texel values vary least over views. Views: the normal and six each at 30 and 60
/// degrees; lights: the normal and three at 45 degrees, each compared with itself alone; `two_sided` adds the mirror
/// images below. Values are luminance x |cos(theta_l)| of the first hit, averaged over texels. They vary because
/// features off the plane move across texels from view to view. A flat tile has only one height.
///
/// Runs in the calling task arena. The result depends on the tile and `two_sided` alone, so that a BTF of these sides
/// and its silhouette show the same texels.
float least_variance_height(const RepeatedTile& tile, bool two_sided, Progress& progress);

inline constexpr int kReferenceHeights = 33;

// What a resumed capture must find again.

/// SHA-256 of what the values of the tile depend on: vertices, triangles, transforms, and coarse images from both
/// sides, which show materials, textures and their coordinates, normals and cutouts. Runs in the calling task arena.
std::string tile_hash(const RepeatedTile& tile, Progress& progress);

}  // namespace velour
