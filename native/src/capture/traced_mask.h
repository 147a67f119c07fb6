// Which texels a view finds covered, by rays that meet the geometry itself.
#pragma once

#include "capture/repeated_tile.h"
#include "votf/visibility_mask.h"

namespace velour {

/// V of the texels' centres on the plane of local height `reference`: 1 where the line through the centre along `wv`
/// meets the tile. A ray a texel, a batch a row; `log` may be null.
std::vector<uint8_t> traced_mask(const RepeatedTile& tile, const TileTexels& texels, float reference, const Vec3& wv,
                                 RayLog* log = nullptr);

}  // namespace velour
