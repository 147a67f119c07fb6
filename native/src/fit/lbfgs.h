// Descent of a smooth function of many parameters by limited-memory BFGS.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace velour {

/// The value at `x`; writes the slope.
using SmoothFunction = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& slope)>;

struct LbfgsOptions {
  int steps = 100;
  int memory = 12;        // pairs of steps and changes of slope that are kept
  double settled = 1e-6;  // relative gain of ten steps that ends the descent
};

/// Minimises `f` from `x` ([NW06], Algorithms 7.4 and 3.1: two loops, backtracking). Never worse than the start.
/// `after_step` is called once a step with its number.
Eigen::VectorXd descend_lbfgs(const SmoothFunction& f, Eigen::VectorXd x, const LbfgsOptions& options,
                              const std::function<void(int)>& after_step);

}  // namespace velour
