// Half floats, as BTFs are kept: two bytes a value.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace velour {

/// The bits of an IEEE half float.
using HalfBits = uint16_t;

inline constexpr float kLargestHalf = 65504.0f;

/// Same lengths. Exact.
void halves_to_floats(std::span<const HalfBits> halves, std::span<float> floats);

/// One of them, which must be finite: for values that do not lie side by side.
inline float finite_half_to_float(HalfBits half) {
  const uint32_t magnitude = half & 0x7fffu;
  const float value = magnitude < 0x0400u ? static_cast<float>(magnitude) * 0x1p-24f
                                          : std::bit_cast<float>((magnitude << 13) + ((127u - 15u) << 23));
  return (half & 0x8000u) != 0 ? -value : value;
}

/// Same lengths. To the nearest, ties to even; beyond kLargestHalf becomes infinite.
void floats_to_halves(std::span<const float> floats, std::span<HalfBits> halves);

}  // namespace velour
