// One step of a pyramid of mip levels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace velour {

/// Sizes of the next level: half, rounded down, at least 1.
inline uint32_t half_of(uint32_t extent) { return extent > 1 ? extent / 2 : 1; }

/// The level after `image` ([row][column][channel], `width` x `height`): every texel the mean over the area that it
/// covers of the finer level, whatever the sizes.
std::vector<float> half_image(std::span<const float> image, uint32_t width, uint32_t height, uint32_t channels);

}  // namespace velour
