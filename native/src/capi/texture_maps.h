// Conversion of texture coordinate maps.
#pragma once

#include "material/texture_map.h"

namespace velour::capi {

/// `m` [2 x 3, row-major] is applied to (u, v, 1).
inline TextureMap map_from(const float* m) { return {{m[0], m[3], m[1], m[4]}, {m[2], m[5]}}; }

}  // namespace velour::capi
