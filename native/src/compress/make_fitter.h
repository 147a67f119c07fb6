// The fits of BTFs by method.
#pragma once

#include <memory>

#include "compress/btf_fitter.h"
#include "compress/compress_btf.h"
#include "compress/fit_checkpoint.h"
#include "compress/fit_memory.h"

namespace velour {

/// All arguments must outlive it. Throws what the fitters do, and Error(invalid_argument) for clusters
/// and members that the method has not.
std::unique_ptr<BtfFitter> make_fitter(const BtfMeasurement& measurement, const CompressOptions& options,
                                       FitCheckpoint& checkpoint, Progress& progress);

/// What such a fit is about to take; nothing is read. Throws Error(unsupported) for a layout that is not complete.
FitSize fit_size(const BtfMeasurement& measurement, const CompressOptions& options);

}  // namespace velour
