// The data that fits may not read, so that errors are measured on unseen data. The only definition of that rule.
#pragma once

#include <array>
#include <cstdint>

#include "math/sphere/random.h"

namespace velour {

/// Views at which errors are reported, degrees from the normal. Fits of tables read no view within kHeldOutMargin.
inline constexpr std::array<int, 5> kHeldOutViews{5, 30, 60, 75, 85};
inline constexpr double kHeldOutMargin = 1.0;  // degrees

/// Irregular samples count for the nearest of these views if no further than this.
inline constexpr double kHeldOutGroup = 7.5;  // degrees

namespace detail {
/// One index in eight, without the regular pattern that index % 8 would lay over a structured grid.
inline bool one_in_eight(uint64_t stream, uint64_t index) { return mix64(mix64(stream) ^ index) % 8 == 0; }
}  // namespace detail

/// Light direction `index` of a fit's own set of lights.
inline bool held_out_light(uint64_t index) { return detail::one_in_eight(1, index); }

/// Sample `index` of Measurement::samples(). Copies of a sample that a measurement makes by symmetry share the index.
inline bool held_out_sample(uint64_t index) { return detail::one_in_eight(2, index); }

}  // namespace velour
