// Products of tensors with matrices.
#pragma once

#include "base/progress.h"
#include "math/tensor/tensor_view.h"

namespace velour {

/// view x_mode matrix: multiplies every column of the mode's unfolding by `matrix`, which has a column per index of the
/// mode. The result is row-major and bit-identical for any number of threads.
DenseTensor mode_product(const TensorView& view, size_t mode, const RowMatrix& matrix, int threads,
                         const Progress& progress);

/// The unfolding times its transpose, in double: inner products of all pairs of slices of the mode. Bit-identical for
/// any number of threads.
Eigen::MatrixXd slice_products(const TensorView& view, size_t mode, int threads, const Progress& progress);

}  // namespace velour
