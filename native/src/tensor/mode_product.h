// Products of tensors with matrices.
#pragma once

#include "job/progress.h"
#include "tensor/unfolding.h"

namespace velour {

/// view x_mode matrix: every column of the mode's unfolding times `matrix`, whose columns are the mode's indices.
/// Row-major. The same bits for any number of threads.
DenseTensor mode_product(const TensorView& view, size_t mode, const RowMatrix& matrix, int threads,
                         const Progress& progress);

/// The unfolding times its transpose, in double: products of any two slices of the mode. The same bits for any number
/// of threads.
Eigen::MatrixXd slice_products(const TensorView& view, size_t mode, int threads, const Progress& progress);

}  // namespace velour
