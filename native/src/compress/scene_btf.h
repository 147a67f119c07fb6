// A BTF as scenes see it that know some of its views alone, and never come close.
#pragma once

#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "domain/view_weights.h"

namespace velour {

/// Numbers of a layout's views and lights.
struct SeenPairs {
  std::vector<uint32_t> views, lights;
};

/// Of a complete layout: the views no farther from those that count (counted_views) than twice what views lie apart
/// from their nearest neighbours at most: with those around them, which keep a fit from following single views; and the
/// one nearest to the normal, whose heights make the relief. Of a side that nobody saw no views, but its lights, which
/// may come through. What is seen of a BTF of one side from behind is its front.
SeenPairs pairs_around(const PairLayout& layout, const ViewWeights& seen);

/// Whether it has views, and lights, from below.
bool has_lower_side(const PairLayout& layout);

/// `pairs` of `fine` (complete), at the level of its pyramid that lies `halvings` below the finest: values and
/// structure are means over the areas that its texels cover (half_image.h). Read from `fine`, image by image, whenever
/// it is asked for; `fine` outlives it. The provenance is that of `fine`, values that are not finite stay so.
std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings, SeenPairs pairs);

/// An image of `grid`, [row][column][channel], at the level `halvings` below it.
std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings);

}  // namespace velour
