// Inner loop of factored BTFs.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sphere/vec.h"

namespace velour {

/// Row lengths are multiples of this: whole vectors of every instruction set.
inline constexpr uint32_t kFactoredPadding = 16;

/// A row of component values for a direction pair, and its weight.
struct WeightedRow {
  const float* row;
  float weight;
};

/// For each of three ranges [end[a - 1], end[a]) of components, the sum of value x (weighted sum of the rows).
Vec3 factored_sums(const float* value, std::span<const WeightedRow> rows, const std::array<uint32_t, 3>& end);

}  // namespace velour
