// Inner loops of BTFs that are sums of products.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// Rows and values passed to weighted_dot() must be readable this many floats beyond their end.
inline constexpr uint32_t kFactoredSlack = 16;

/// Values of all components for one direction pair or light, and the weight of that pair.
struct WeightedRow {
  const float* row;
  float weight;
};

/// Returns sum over k < `count` of value[k] x (weighted sum of the rows)[k].
float weighted_dot(const float* value, std::span<const WeightedRow> rows, uint32_t count);

/// Adds weight x row[k] to sum[k] for k < `count`.
void add_weighted(const WeightedRow& row, uint32_t count, float* sum);

}  // namespace velour
