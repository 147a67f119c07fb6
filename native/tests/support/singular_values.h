// What matrices are held against.
#pragma once

#include <Eigen/Core>

namespace velour::test {

/// The largest first, to rounding of doubles, by one-sided Jacobi rotations [Hes58], which nothing in the library
/// uses. Of a few hundred rows or columns.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

}  // namespace velour::test
