// A BTF reduced to the views and the resolution of its scene usage.
#pragma once

#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "domain/view_weights.h"

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
/// texels cover (half_image.h). Reads from `fine` image by image on demand; `fine` must outlive the result. Keeps the
/// provenance of `fine`; values that are not finite stay so.
std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings, SeenPairs pairs);

/// Reduces an image of `grid`, [row][column][channel], by `halvings` mip levels.
std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings);

}  // namespace velour
