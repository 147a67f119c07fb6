// Truncated singular value decomposition of a BTF: direction pairs times texels, one matrix a colour axis.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"
#include "job/progress.h"

namespace velour {

struct SvdOptions {
  uint64_t bytes = 0;  // of all coefficients at most; 0: a two-hundredth of the measurement, 8 components at least
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;  // 0: all
};

struct SvdFit {
  FactoredBtf btf;
  uint64_t not_finite = 0;  // entries of the measurement that were left out
};

/// The components of most energy over the three axes, by randomised range finding with two power iterations ([HMT11],
/// Alg. 4.4): after them the loss against the exact decomposition is far below what is cut off. Coarse levels are
/// projections of the filtered measurement, not filtered coefficients: means are kept whatever the companding.
/// Deterministic. Throws Error(invalid_argument) when `bytes` hold not one component.
SvdFit fit_svd(const BtfMeasurement& measurement, const SvdOptions& options, Progress& progress);

}  // namespace velour
