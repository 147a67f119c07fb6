// Non-negative least squares from a Gram matrix.
#pragma once

#include <Eigen/Core>

namespace velour {

/// Minimizes x^T gram x - 2 x^T moment over x >= 0 (active set: Lawson & Hanson 1974 in the Gram form of Bro & de Jong
/// 1997). `x` is the start on entry, whose positive entries are the first passive set, and the solution on return. A
/// ridge of `ridge` times the diagonal handles rank-deficient Gram matrices.
void solve_nnls(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double ridge, Eigen::VectorXd& x);

}  // namespace velour
