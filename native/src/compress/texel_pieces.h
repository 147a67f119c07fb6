// Partition of loops over texels for threads.
#pragma once

#include <cstddef>

namespace velour {

/// Texels per piece of work. Fixed, so that sums do not depend on the number of threads.
inline constexpr size_t kTexelsPerPiece = 64;

}  // namespace velour
