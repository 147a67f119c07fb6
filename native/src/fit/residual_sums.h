// Sums over the samples of a view's residual. SIMD through Highway with run-time dispatch.
#pragma once

#include "fit/slice_samples.h"

namespace velour {

/// Sums of the squares of a residual: of all, and of each sample's share. In floats over a block, in as many lanes on
/// every machine, then in doubles.
struct ResidualSums {
  double all = 0, shared = 0;
};

/// `residual` and `share`: as long, a multiple of SliceSamples::kPadding.
ResidualSums residual_sums(const AlignedFloats& residual, const AlignedFloats& share);

}  // namespace velour
