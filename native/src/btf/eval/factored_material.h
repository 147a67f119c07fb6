// A BTF as a sum of products, evaluated at a site of a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include "btf/eval/measured_btf_material.h"
#include "btf/model/factored_btf.h"
#include "material/material.h"

namespace velour {

// Inner loops of BTFs that are sums of products.

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

/// Texture coordinates are in tiles: the BTF repeats with every whole number. Samples have the density of the cosine: a
/// factorisation knows no lobes to sample from. Where components serve one view each (by_view()), those of at most
/// three views around the direction are evaluated.
std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf,
                                                       BtfLight light = BtfLight::viewers_side);

}  // namespace velour
