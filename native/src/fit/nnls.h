// Non-negative least squares from a Gram matrix.
#pragma once

#include <Eigen/Core>

namespace velour {

/// Minimises x^T gram x - 2 x^T moment over x >= 0 (active set: Lawson & Hanson 1974 in the Gram form of Bro & de Jong
/// 1997). `x` is the start on entry (only which entries are positive matters) and the solution on return. A
/// rank-deficient Gram matrix is met with a ridge of `ridge` times its diagonal.
void solve_nnls(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double ridge, Eigen::VectorXd& x);

}  // namespace velour
