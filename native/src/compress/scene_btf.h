// A BTF as scenes see it that know some of its views alone, and never come close.
#pragma once

#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "sphere/view_range.h"

namespace velour {

/// Numbers of the views whose polar angle (from either side) lies within `range`, or no farther from it than twice
/// what views lie apart from their nearest neighbours at most: with those around them, which keep a fit from following
/// single views. All views where the range is whole.
std::vector<uint32_t> views_around(const PairLayout& layout, const ViewRange& range);

/// `views` of `fine` (complete), at the level of its pyramid that lies `halvings` below the finest: values and
/// structure are means over the areas that its texels cover (half_image.h). Read from `fine`, image by image, whenever
/// it is asked for; `fine` outlives it. The provenance is that of `fine`, values that are not finite stay so.
std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings,
                                                std::vector<uint32_t> views);

/// An image of `grid`, [row][column][channel], at the level `halvings` below it.
std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings);

}  // namespace velour
