// Decompositions of dense matrices, and bases of the modes of tensors.
#pragma once

#include <cstdint>
#include "base/progress.h"
#include "math/tensor/tensor_view.h"

namespace velour {

// Bases of the modes of tensors.

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

// Decompositions of dense matrices. Instantiated here only, because each takes ten seconds to compile.

/// Eigenvalues and eigenvectors of a symmetric matrix, largest value first; vectors are orthonormal columns.
struct Eigenpairs {
  Eigen::VectorXd value;
  Eigen::MatrixXd vector;
};

/// All eigenpairs; reads only the lower triangle.
Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The symmetric inverse of the square root of a positive definite matrix.
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& symmetric);

/// Orthonormal basis of the columns of `m`, with as many columns as `m`, which has no more columns than rows.
RowMatrix orthonormal(const RowMatrix& m);
Eigen::MatrixXd orthonormal_doubles(const Eigen::MatrixXd& m);

/// m = basis * triangle.
struct QrParts {
  RowMatrix basis;     // as orthonormal(m)
  RowMatrix triangle;  // upper
};
QrParts qr_parts(const RowMatrix& m);

// Tucker decompositions of tensors.

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
