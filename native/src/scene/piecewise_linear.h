// One-dimensional densities that are linear within cells of equal width. Sampling by inversion is monotone in u, so a
// stratified u stays stratified.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace velour {

/// Fills `cdf` [cells + 1], the cumulative fraction of the mass at each cell's edge, and `guide` [cells] from the
/// masses of at most 65536 cells, and returns their sum. All zero: uniform. guide[k] is the cell that contains
/// u = k / cells, so that the search in find_cell takes O(1) steps on average [CA74].
template <typename Index>
double build_cells(const std::vector<double>& mass, float* cdf, Index* guide) {
  const size_t cells = mass.size();
  double total = 0.0;
  for (double m : mass) total += m;
  double sum = 0.0;
  for (size_t i = 0; i < cells; ++i) {
    cdf[i] = static_cast<float>(total > 0.0 ? sum / total : static_cast<double>(i) / static_cast<double>(cells));
    sum += mass[i];
  }
  cdf[cells] = 1.0f;
  size_t cell = 0;
  for (size_t k = 0; k < cells; ++k) {
    const float u = static_cast<float>(k) / static_cast<float>(cells);
    while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
    guide[k] = static_cast<Index>(cell);
  }
  return total;
}

inline size_t guide_place(float u, int cells) {
  return static_cast<size_t>(std::min(static_cast<int>(u * static_cast<float>(cells)), cells - 1));
}

/// The cell that contains `u`; `cell` is guide[guide_place(u, cells)].
inline int find_cell(const float* cdf, int cell, int cells, float u) {
  while (cell > 0 && cdf[cell] > u) --cell;  // u * cells may have been rounded up
  while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
  return cell;
}

}  // namespace velour
