// A BTF reduced to the views and the resolution of its scene usage.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>
#include "btf/measure/btf_measurement.h"
#include "model/model.h"
#include "usage/scene_domain.h"

namespace velour {

/// Indices of a layout's views and lights.
struct SeenPairs {
  std::vector<uint32_t> views, lights;
};

/// Selects from a complete layout the views no farther from a counted one (counted_views) than twice the largest
/// distance between nearest neighbors, because the surrounding views keep a fit from following single views; and the
/// view nearest to the normal, whose heights make the relief. A side that was not seen contributes no views, but its
/// lights, which may be transmitted. A one-sided BTF shows its front from behind.
SeenPairs pairs_around(const PairLayout& layout, const ViewWeights& seen);

/// Whether the layout has both views and lights below the plane.
bool has_lower_side(const PairLayout& layout);

/// The given pairs of `fine` (complete) at mip level `halvings`: values and structure are means over the areas that its
/// texels cover (half_image). Reads from `fine` image by image on demand; `fine` must outlive the result. Keeps the
/// provenance of `fine`; values that are not finite stay so.
std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings, SeenPairs pairs);

/// Reduces an image of `grid`, [row][column][channel], by `halvings` mip levels.
std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings);

// Removes the levels of a BTF's model that scenes never resolve.

/// Number of finest levels that can be removed: the next one still has kTexelsOfLookUp texels along every lookup that
/// counts (finest_footprint). The last level stays. For a tile of unknown size, so do levels whose removal would change
/// the ratio of its texel counts, which defines its shape.
size_t unresolved_levels(const ModelBody& body, const SurfaceDomain& seen);

/// The body without its `count` finest levels. Its grid is that of the finest remaining level, so a footprint, counted
/// in its texels, selects the same level as before; coefficients are unchanged bit for bit.
ModelBody without_finest(const ModelBody& body, size_t count);

}  // namespace velour
