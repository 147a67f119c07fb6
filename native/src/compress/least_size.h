// Search for the smallest sufficient size with few trials.
#pragma once

#include <cstddef>
#include <functional>

namespace velour {

/// Sizes are numbered from 0. Doubles the size from the smallest until one is good, then searches between it and the
/// previous one, to within a fifth. The candidate sizes do not depend on `good`, and larger sizes are not assumed to be
/// better: a search that accepts every size that another one accepts never returns a larger size.
///
/// `good`: whether a size is sufficient. Returns a good size, or `end` if none is found below it.
size_t least_size(size_t end, const std::function<bool(size_t)>& good);

}  // namespace velour
