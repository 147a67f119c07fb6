// Products of float matrices, with the widest instructions of the processor.
#pragma once

#include <Eigen/Core>

namespace velour {

using Index = Eigen::Index;

/// Non-owning view of a matrix with any strides.
template <class T>
struct StridedMatrix {
  T* data;
  Index rows, columns, row_stride, column_stride;
};

/// `product` = a b. Each entry is summed in the order of its factors, in floats.
void multiply(const StridedMatrix<const float>& a, const StridedMatrix<const float>& b,
              const StridedMatrix<float>& product);

/// `product` = a x for an `a` stored by columns (row_stride 1). Each entry is summed in the order of its factors, in
/// floats.
void multiply(const StridedMatrix<const float>& a, const float* x, float* product);

/// `product` = a a^T, on and below the diagonal; entries above it are unspecified.
void multiply_by_itself(const StridedMatrix<const float>& a, const StridedMatrix<float>& product);

}  // namespace velour
