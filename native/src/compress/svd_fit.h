// Truncated singular value decomposition of a BTF: direction pairs times texels, one matrix a colour axis.
#pragma once

#include <cstdint>

#include "btf/factored_btf.h"
#include "compress/btf_fit_options.h"
#include "job/progress.h"

namespace velour {

struct SvdFit {
  FactoredBtf btf;
  uint64_t not_finite = 0;  // entries of the measurement that were left out
};

/// The components of most energy over the three axes, by randomised range finding with two power iterations ([HMT11],
/// Alg. 4.4): after them the loss against the exact decomposition is far below what is cut off. Coarse levels are
/// projections of the filtered measurement, not filtered coefficients: means are kept whatever the companding.
/// Deterministic. Without `bytes`, at least 8 components. Throws Error(invalid_argument) when `bytes` hold not one.
SvdFit fit_svd(const BtfMeasurement& measurement, const BtfFitOptions& options, Progress& progress);

}  // namespace velour
