// Creates BTF fitters by method.
#pragma once

#include <memory>

#include "compress/btf_fitter.h"
#include "compress/compress_btf.h"
#include "compress/fit_checkpoint.h"
#include "compress/fit_memory.h"

namespace velour {

/// The arguments must outlive the fitter. Throws the errors of the fitters, and Error(invalid_argument) for clusters,
/// members or no relief where the method does not support them.
std::unique_ptr<BtfFitter> make_fitter(const BtfMeasurement& measurement, const CompressOptions& options,
                                       FitCheckpoint& checkpoint, Progress& progress);

/// Estimated requirements of such a fit; reads no data. Throws Error(unsupported) for an incomplete layout.
FitSize fit_size(const BtfMeasurement& measurement, const CompressOptions& options);

}  // namespace velour
