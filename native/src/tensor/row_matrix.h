// Matrices as tensors and images hold them.
#pragma once

#include <Eigen/Core>

namespace velour {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace velour
