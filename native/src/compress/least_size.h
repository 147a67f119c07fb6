// The least of many sizes that is good enough, by few trials.
#pragma once

#include <cstddef>
#include <functional>

namespace velour {

/// Sizes are numbered from 0 on. Looks at doubled sizes from the smallest on until one is good, then between that and
/// the one before, to a fifth. Which sizes there are to look at does not depend on what is sought, and larger ones are
/// not taken for better: so a search that finds good whatever another one does never ends with a larger size.
///
/// `good`: whether a size is. Returns a size that is good, or `end` where none is found below it.
size_t least_size(size_t end, const std::function<bool(size_t)>& good);

}  // namespace velour
