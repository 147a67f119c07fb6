// Sums over the samples of a view's residual. SIMD through Highway with run-time dispatch.
#pragma once

#include "brdf/fit/slice_samples.h"

namespace velour {

/// Sums of the squares of a residual: of all, and of each sample's share. In float within a block, with the same number
/// of lanes on every machine, then in double.
struct ResidualSums {
  double all = 0, shared = 0;
};

/// `residual` and `share` have the same length, a multiple of SliceSamples::kPadding.
ResidualSums residual_sums(const AlignedFloats& residual, const AlignedFloats& share);

}  // namespace velour
