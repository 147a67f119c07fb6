// Weighted sums of rows of half floats.
#pragma once

#include <array>
#include <cstdint>

#include "btf/half_floats.h"

namespace velour {

inline constexpr uint32_t kHalfRowPadding = 16;

/// A row and its weight.
struct WeightedHalves {
  const HalfBits* row;
  float weight;
};

/// to[i] += sum over the four rows of weight row[i], i < count; `count` is a multiple of kHalfRowPadding, `to` aligned
/// to 64 bytes.
void add_half_rows(const std::array<WeightedHalves, 4>& rows, uint32_t count, float* to);

}  // namespace velour
