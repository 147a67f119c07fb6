// Which sampled views stand for a view direction, and with what weight (method 6.4).
#pragma once

#include <span>

#include "sphere/vec.h"

namespace velour {

inline constexpr int kMaxNeighbors = 8;

/// Indices into a set of views; the weights are positive and sum to 1. Empty only for an empty set.
struct ViewNeighbors {
  int count = 0;
  int index[kMaxNeighbors];
  float weight[kMaxNeighbors];
};

/// The two polar angles of sorted `theta` (radians) that enclose `theta_v`, with linear weights; the end alone beyond.
ViewNeighbors bracketing_views(std::span<const float> theta, float theta_v);

/// The `k` <= kMaxNeighbors nearest of `views` with weight 1/angle_i - 1/angle_(k+1), so that a view's weight has
/// fallen to 0 when another takes its place. A hit gives that view alone.
ViewNeighbors nearest_views(std::span<const Vec3> views, const Vec3& wv, int k);

}  // namespace velour
