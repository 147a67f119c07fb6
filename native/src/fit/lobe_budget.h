// Number of lobes that each view may keep if the size of the model is bounded.
#pragma once

#include <cstdint>
#include <vector>

#include "fit/slice_fit.h"

namespace velour {

/// The greedy path of one view, and the importance of its error.
struct ViewPath {
  std::vector<SliceFit> path;
  double importance;  // cos(theta_v): the weight of the view in relative_l2
};

/// Number of lobes of each view, at most `lobes` in total. Lobes are removed where they lower the weighted sum of
/// squared errors least: the exact minimum if the squared errors along each path are convex, otherwise close to it.
std::vector<size_t> share_lobes(const std::vector<ViewPath>& views, uint64_t lobes);

/// Indices of `keep` of `count` views, evenly spread, including the first and last.
std::vector<size_t> thinned(size_t count, size_t keep);

}  // namespace velour
