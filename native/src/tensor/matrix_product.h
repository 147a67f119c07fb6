// Products of matrices of floats, by the widest instructions that the processor has.
#pragma once

#include <Eigen/Core>

namespace velour {

using Index = Eigen::Index;

/// Somewhere in memory, with any strides; owns nothing.
template <class T>
struct StridedMatrix {
  T* data;
  Index rows, columns, row_stride, column_stride;
};

/// `product` = a b. Each entry is summed in the order of its factors, in floats.
void multiply(const StridedMatrix<const float>& a, const StridedMatrix<const float>& b,
              const StridedMatrix<float>& product);

/// `product` = a times its transpose: what lies on and below the diagonal; above it anything.
void multiply_by_itself(const StridedMatrix<const float>& a, const StridedMatrix<float>& product);

}  // namespace velour
