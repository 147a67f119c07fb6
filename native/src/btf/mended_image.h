// Replacement of non-finite values in images.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// Replaces non-finite values of `image` ([texel][channel], three channels) by the mean of the finite ones, per
/// channel, so that they do not bias a fit. Returns their number.
uint64_t mend_image(std::span<float> image);

}  // namespace velour
