// A BTF fitted by sums of multivariate SRBFs over a relief.
#pragma once

#include <cstdint>

#include "btf/srbf_btf.h"
#include "compress/btf_fit_options.h"
#include "job/progress.h"

namespace velour {

struct SrbfFit {
  SrbfBtf btf;
  uint64_t not_finite = 0;  // entries of the measurement that were left out
};

/// Lobes that all texels share are chosen and refined by what random points of the surface show, then the texels of
/// every level are solved for, each level from the coarser one. Deterministic. Throws Error(invalid_argument) when
/// `bytes` hold not one coefficient, Error(unsupported) for a layout that is not complete.
SrbfFit fit_srbf(const BtfMeasurement& measurement, const BtfFitOptions& options, Progress& progress);

}  // namespace velour
