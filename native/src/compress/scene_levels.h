// Removes the levels of a BTF's model that scenes never resolve.
#pragma once

#include <cstddef>

#include "domain/surface_domain.h"
#include "model/model.h"

namespace velour {

/// Number of finest levels that can be removed: the next one still has kTexelsOfLookUp texels along every lookup that
/// counts (finest_footprint). The last level stays. For a tile of unknown size, so do levels whose removal would change
/// the ratio of its texel counts, which defines its shape.
size_t unresolved_levels(const ModelBody& body, const SurfaceDomain& seen);

/// The body without its `count` finest levels. Its grid is that of the finest remaining level, so a footprint, counted
/// in its texels, selects the same level as before; coefficients are unchanged bit for bit.
ModelBody without_finest(const ModelBody& body, size_t count);

}  // namespace velour
