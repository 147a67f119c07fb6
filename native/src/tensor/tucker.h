// Tucker decompositions of tensors.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// A tensor ~ core x_0 factor[0] x_1 factor[1] ...; the columns of the factors are orthonormal and the core is the
/// projection of the tensor on them, so the squared error is |tensor|^2 - |core|^2.
struct Tucker {
  std::vector<RowMatrix> factor;  // of each mode, extent x rank
  DenseTensor core{{}};
};

/// Truncated higher-order singular values, mode after mode ([VVM12]): each mode's factor is found in what the modes
/// before it left, those first that shrink most. `ranks` at most the extents.
Tucker truncated_hosvd(const TensorView& view, const std::vector<Index>& ranks, const TensorOptions& options,
                       const Progress& progress);

/// One sweep of higher-order orthogonal iteration ([DDV00]): each mode's factor is the best one for the others. Never
/// raises the error (beyond rounding).
void hooi_sweep(const TensorView& view, Tucker& tucker, const TensorOptions& options, const Progress& progress);

/// view times the transposed factors of all modes but `but` (none: order()). An empty factor leaves its mode alone.
DenseTensor projected(const TensorView& view, const std::vector<RowMatrix>& factor, size_t but,
                      const TensorOptions& options, const Progress& progress);

/// The tensor that a decomposition stands for.
DenseTensor expanded(const Tucker& tucker, const TensorOptions& options, const Progress& progress);

}  // namespace velour
