// Half floats, the storage format of BTFs.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace velour {

/// The bits of an IEEE half float.
using HalfBits = uint16_t;

inline constexpr float kLargestHalf = 65504.0f;

/// Both spans have the same length. Exact.
void halves_to_floats(std::span<const HalfBits> halves, std::span<float> floats);

/// Converts a single finite value, for values that are not contiguous.
inline float finite_half_to_float(HalfBits half) {
  const uint32_t magnitude = half & 0x7fffu;
  const float value = magnitude < 0x0400u ? static_cast<float>(magnitude) * 0x1p-24f
                                          : std::bit_cast<float>((magnitude << 13) + ((127u - 15u) << 23));
  return (half & 0x8000u) != 0 ? -value : value;
}

/// Both spans have the same length. Rounds to nearest, ties to even; overflow gives infinity.
void floats_to_halves(std::span<const float> floats, std::span<HalfBits> halves);

}  // namespace velour
