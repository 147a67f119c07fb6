// Residuals of clustered slices.
#pragma once

#include <span>

#include "tensor/clustered_tensor.h"

namespace velour {

/// Residuals [slice of `which`][entry]: slices minus the parts of all their clusters except `but`; an index past the
/// last cluster excludes none. `slices`: row-major; `basis`: one per cluster. Slices without members stay unchanged.
/// Bit-identical for any number of threads.
DenseTensor cluster_rests(const TensorView& slices, const ClusteredTensor& tensor, const std::vector<RowMatrix>& basis,
                          std::span<const Index> which, uint32_t but, const TensorOptions& options,
                          const Progress& progress);

}  // namespace velour
