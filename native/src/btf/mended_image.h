// Pictures with holes.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// How many of `image` ([texel][channel], three channels) are not finite; those become the mean of the rest, channel by
/// channel, so that they pull at nothing.
uint64_t mend_image(std::span<float> image);

}  // namespace velour
