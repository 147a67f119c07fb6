// Downsampling by one mip level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace velour {

/// Extent of the next mip level: half, rounded down, at least 1.
inline uint32_t half_of(uint32_t extent) { return extent > 1 ? extent / 2 : 1; }

/// The mip level after `image` ([row][column][channel], `width` x `height`). Each texel is the mean over the area of
/// the finer level that it covers, for any sizes.
std::vector<float> half_image(std::span<const float> image, uint32_t width, uint32_t height, uint32_t channels);

}  // namespace velour
