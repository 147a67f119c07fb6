// A BTF's model at the resolution that scenes need.
#pragma once

#include "domain/surface_domain.h"
#include "model/model.h"

namespace velour {

/// The texels of a model for what was seen: kTexelsOfLookUp of them along every look-up that counts (finest_footprint).
/// Never more than the model has.
TexelGrid seen_grid(const TexelGrid& full, const SurfaceDomain& seen);

/// Texels along the width of the finest look-up. A look-up stands for a pixel, and several rays of a pixel see within
/// it: with fewer texels their interpolation blurs what their mean should keep.
inline constexpr double kTexelsOfLookUp = 1.4142135;

/// The body with a pyramid from `grid` on. The finest level comes from the finest one of the body, each other from the
/// coarsest that is no smaller; both by resampling() (resampled_map.h), which averages over `window` of the tile. A
/// level that keeps its size stays as it is, bit for bit.
ModelBody at_resolution(const ModelBody& body, const TexelGrid& grid, double window);

}  // namespace velour
