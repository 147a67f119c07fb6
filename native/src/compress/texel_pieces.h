// How loops over texels are cut for threads.
#pragma once

#include <cstddef>

namespace velour {

/// Texels of a piece of work: fixed, so that sums do not depend on the number of threads.
inline constexpr size_t kTexelsPerPiece = 64;

}  // namespace velour
