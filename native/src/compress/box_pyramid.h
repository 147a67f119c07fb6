// Images over a periodic tile, filtered down to one texel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace velour {

/// The level after `image` ([row][column][channel], `width` x `height`): every texel the mean over the area that it
/// covers of the finer level, whatever the sizes.
std::vector<float> half_image(std::span<const float> image, uint32_t width, uint32_t height, uint32_t channels);

}  // namespace velour
