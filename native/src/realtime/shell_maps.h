// The shell of a material (VOTF) as the volume that a shader interpolates.
#pragma once

#include "realtime/table_pixels.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// volume.depth layers, the lowest first, one above the other in the table, each of volume.height + 2 rows of
/// volume.width + 2 pixels with a border of one that repeats the tile: the signed distance, in widths of the tile, and
/// its slope along x, y and z. Throws Error(unsupported) beyond kMostShellPixels.
TablePixels shell_maps(const OcclusionVolume& volume);

inline constexpr uint64_t kMostShellPixels = uint64_t{1} << 23;

}  // namespace velour
