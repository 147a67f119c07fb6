// Row-major matrices, the layout of tensors and images.
#pragma once

#include <Eigen/Core>

namespace velour {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace velour
