// The VOTF of a material as a volume that a shader interpolates.
#pragma once

#include "realtime/lobe_rows.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

/// The table stacks volume.depth layers vertically, the lowest first, each of volume.height + 2 rows of volume.width +
/// 2 pixels with a border of one pixel that repeats the tile. A pixel is the signed distance in tile widths and its
/// slope along x, y and z. Throws Error(unsupported) beyond kMaxShellPixels.
TablePixels shell_maps(const VotfVolume& volume);

inline constexpr uint64_t kMaxShellPixels = uint64_t{1} << 23;

}  // namespace velour
