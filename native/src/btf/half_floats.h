// Half floats, as BTFs are kept: two bytes a value.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// The bits of an IEEE half float.
using HalfBits = uint16_t;

inline constexpr float kLargestHalf = 65504.0f;

/// Same lengths. Exact.
void halves_to_floats(std::span<const HalfBits> halves, std::span<float> floats);

/// Same lengths. To the nearest, ties to even; beyond kLargestHalf becomes infinite.
void floats_to_halves(std::span<const float> floats, std::span<HalfBits> halves);

}  // namespace velour
