// One-dimensional densities that run linearly over equal cells, sampled by inversion: monotone in u, so a stratified u
// stays stratified.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace velour {

/// Fills `cdf` [cells + 1], the running share of the mass at each cell's edge, and `guide` [cells] from the masses of
/// at most 65536 cells; returns their sum. All zero: uniform. guide[k] is the cell that holds u = k / cells, so that
/// the search of find_cell takes O(1) steps on average [CA74].
double build_cells(const std::vector<double>& mass, float* cdf, uint16_t* guide);

inline size_t guide_place(float u, int cells) {
  return static_cast<size_t>(std::min(static_cast<int>(u * static_cast<float>(cells)), cells - 1));
}

/// The cell that holds `u`; `cell` is guide[guide_place(u, cells)].
inline int find_cell(const float* cdf, int cell, int cells, float u) {
  while (cell > 0 && cdf[cell] > u) --cell;  // u * cells may have been rounded up
  while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
  return cell;
}

/// Where in [0, 1] the density that runs linearly from `a` to `b` reaches the share `u` of its mass.
inline float invert_linear(float a, float b, float u) {
  if (!(a + b > 0.0f) || u <= 0.0f) return u;
  // Root of a t + (b - a) t^2 / 2 = u (a + b) / 2 in the form without cancellation.
  const float root = std::sqrt((1.0f - u) * a * a + u * b * b);
  return std::min(u * (a + b) / (a + root), 1.0f);
}

}  // namespace velour
