// Bases of the modes of tensors.
#pragma once

#include <cstdint>
#include "base/progress.h"
#include "math/tensor/tensor_view.h"

namespace velour {

/// Options of tensor algorithms; results do not depend on `threads`.
struct TensorOptions {
  uint64_t seed = 0;  // for random starts
  int threads = 0;    // 0: all
};

/// The `rank` leading left singular vectors of a mode's unfolding, as orthonormal columns, strongest first. Uses the
/// eigenvectors of the Gram matrix of the shorter side, or random_range with a few extra columns if both sides exceed
/// 1024.
RowMatrix leading_vectors(const TensorView& view, size_t mode, Index rank, const TensorOptions& options,
                          const Progress& progress);

/// Orthonormal columns that approximately span the leading left singular vectors: the unfolding times random columns,
/// multiplied `powers` times by the unfolding and its transpose ([HMT11] algorithm 4.4).
RowMatrix random_range(const TensorView& view, size_t mode, Index columns, int powers, const TensorOptions& options,
                       const Progress& progress);

// Leading eigenvectors of symmetric matrices.

/// The `rank` eigenvectors of the largest eigenvalues of a positive semidefinite matrix, as orthonormal columns,
/// strongest first. If they are few and the matrix is large, uses a block Krylov space ([MM15] algorithm 2) that grows
/// until they are exact to rounding of the floats that `products` are summed from; otherwise decomposes the matrix.
Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& products, Index rank, const TensorOptions& options,
                                     const Progress& progress);

}  // namespace velour
