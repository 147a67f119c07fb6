// Few lobes in the place of many, for drawing from them.
#pragma once

#include "srbf/lobe_tree.h"

namespace velour {

/// The fewest nodes of the tree of `lobes` whose sum is within `tolerance` (relative L2 over the sphere) of theirs;
/// `most` (> 0) nodes where none are as near. Widest first, as nested lobes want to be drawn (LobeDraws::choose).
///
/// Why few: each lobe takes a slice of the unit square to itself, and points spread evenly over the square are spread
/// evenly over the sum of two lobes only as far as each is by its own. So an exact density of many lobes loses more to
/// its slices than a coarse one of few.
std::vector<GaussianLobe> few_lobes(const GaussianLobes& lobes, double tolerance, int most);

}  // namespace velour
