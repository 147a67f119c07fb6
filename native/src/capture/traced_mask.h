// Coverage of texels in a view, by rays against the geometry itself.
#pragma once

#include "capture/repeated_tile.h"
#include "votf/visibility_mask.h"

namespace velour {

/// V at the texels' centers on the plane of local height `reference`: 1 where the line through the center along `wv`
/// hits the tile. One ray per texel, one batch per row; `log` may be null.
std::vector<uint8_t> traced_mask(const RepeatedTile& tile, const TileTexels& texels, float reference, const Vec3& wv,
                                 RayLog* log = nullptr);

}  // namespace velour
