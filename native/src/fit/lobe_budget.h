// How many lobes each view may keep when the model has a bound in bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "fit/slice_fit.h"

namespace velour {

/// The greedy path of one view, and how much its error counts.
struct ViewPath {
  std::vector<SliceFit> path;
  double importance;  // cos(theta_v): the weight of the view in relative_l2
};

/// Lobes a view such that all views together take at most `lobes`: lobes go where they lower the weighted sum of
/// squared errors least. The exact minimum where errors fall ever more slowly along each path, near it elsewhere.
std::vector<size_t> share_lobes(const std::vector<ViewPath>& views, uint64_t lobes);

/// Indices of `keep` of `count` views, evenly spread, first and last among them.
std::vector<size_t> thinned(size_t count, size_t keep);

}  // namespace velour
