// The sampled views that are mixed for a view direction, and their weights (method 6.4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

inline constexpr int kMaxNeighbors = 8;

/// Indices into a set of views; the weights are positive and sum to 1. Empty only for an empty set.
struct ViewNeighbors {
  int count = 0;
  int index[kMaxNeighbors];
  float weight[kMaxNeighbors];
};

/// Linear weights of the two polar angles of sorted `theta` (radians) around `theta_v`; beyond an end, that end alone.
ViewNeighbors bracketing_views(std::span<const float> theta, float theta_v);

/// Search for the nearest of a set of views. Candidates are tabulated by direction, so that a search tests a dozen
/// views instead of all. Immutable; thread-safe.
class ViewSearch {
 public:
  /// Searches for the `k` <= kMaxNeighbors nearest of `views`.
  ViewSearch(std::span<const Vec3> views, int k);

  /// The k nearest views of unit `wv` with weight 1/angle_i - 1/angle_(k+1), so that a view's weight has fallen to 0
  /// when another takes its place. A hit gives that view alone.
  ViewNeighbors nearest(const Vec3& wv) const;

 private:
  void fill_cell(int cell);
  static constexpr int kSide = 32;  // octahedral cells per side; even, so that no fold of the map crosses a cell

  std::vector<Vec3> views_;
  int k_;
  std::vector<uint32_t> candidates_, first_;  // candidates of cell c: [first_[c], first_[c + 1]), increasing
};

}  // namespace velour
