// Tucker decompositions of tensors.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// A tensor ~ core x_0 factor[0] x_1 factor[1] ...; the columns of the factors are orthonormal and the core is the
/// projection of the tensor on them, so the squared error is |tensor|^2 - |core|^2.
struct Tucker {
  std::vector<RowMatrix> factor;  // one per mode, extent x rank
  DenseTensor core{{}};
};

/// Sequentially truncated higher-order SVD ([VVM12]): the factor of each mode is computed from the projection on the
/// factors of the previous modes; modes that shrink most come first. `ranks` do not exceed the extents.
Tucker truncated_hosvd(const TensorView& view, const std::vector<Index>& ranks, const TensorOptions& options,
                       const Progress& progress);

/// One sweep of higher-order orthogonal iteration ([DDV00]): replaces the factor of each mode by the best one for the
/// others. Never raises the error (beyond rounding).
void hooi_sweep(const TensorView& view, Tucker& tucker, const TensorOptions& options, const Progress& progress);

/// `view` times the transposed factors of all modes except `but` (order(): all modes). An empty factor skips its mode.
DenseTensor projected(const TensorView& view, const std::vector<RowMatrix>& factor, size_t but,
                      const TensorOptions& options, const Progress& progress);

/// Reconstructs the tensor of a decomposition.
DenseTensor expanded(const Tucker& tucker, const TensorOptions& options, const Progress& progress);

}  // namespace velour
