// Leading eigenvectors of symmetric matrices.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// The `rank` eigenvectors of the largest eigenvalues of a positive semidefinite matrix, as orthonormal columns,
/// strongest first. If they are few and the matrix is large, uses a block Krylov space ([MM15] algorithm 2) that grows
/// until they are exact to rounding of the floats that `products` are summed from; otherwise decomposes the matrix.
Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& products, Index rank, const TensorOptions& options,
                                     const Progress& progress);

}  // namespace velour
