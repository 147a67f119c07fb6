// Which levels of a BTF's model scenes never resolve, and the model without them.
#pragma once

#include <cstddef>

#include "domain/surface_domain.h"
#include "model/model.h"

namespace velour {

/// How many of the finest levels may go: the next one still has kTexelsOfLookUp texels along every look-up that counts
/// (finest_footprint). The last level stays, and so do levels without which the texels of a tile of unknown size would
/// have another shape: their numbers are what tells the tile's.
size_t unresolved_levels(const ModelBody& body, const SurfaceDomain& seen);

/// The body without its `count` finest levels. Its grid is that of the finest one left, so a footprint, counted in its
/// texels, finds the same level as before; coefficients stay as they are, bit for bit.
ModelBody without_finest(const ModelBody& body, size_t count);

}  // namespace velour
