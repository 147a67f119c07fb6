// Minimizes a smooth function of many parameters by limited-memory BFGS.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace velour {

/// Returns the value at `x` and writes the gradient to `slope`.
using SmoothFunction = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& slope)>;

struct LbfgsOptions {
  int steps = 100;
  int memory = 12;        // number of stored pairs of step and change of slope
  double settled = 1e-6;  // relative gain over ten steps below which the descent ends
};

/// Minimizes `f` from `x` ([NW06], Algorithms 7.4 and 3.1: two loops, backtracking). Never worse than the start.
/// Calls `after_step` after each step with its number.
Eigen::VectorXd descend_lbfgs(const SmoothFunction& f, Eigen::VectorXd x, const LbfgsOptions& options,
                              const std::function<void(int)>& after_step);

}  // namespace velour
