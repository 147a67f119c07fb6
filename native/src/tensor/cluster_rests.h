// What clusters leave of slices.
#pragma once

#include <span>

#include "tensor/clustered_tensor.h"

namespace velour {

/// [slice of `which`][entry]: slices less what their clusters make of them, but for the cluster `but`, which may be one
/// that is not there. `slices`: row-major; `basis`: of each cluster. Before members were chosen they are left whole.
/// The same bits for any number of threads.
DenseTensor cluster_rests(const TensorView& slices, const ClusteredTensor& tensor, const std::vector<RowMatrix>& basis,
                          std::span<const Index> which, uint32_t but, const TensorOptions& options,
                          const Progress& progress);

}  // namespace velour
