// The damped Gauss-Newton step of the parametric model, without its big matrix.
//
// A view touches three nodes of the spline (nine of a hemisphere's), so the matrix is a sum of small ones, one a view.
// Conjugate gradients with the nodes' own blocks as preconditioner solve it: neighbouring nodes of a quadratic spline
// are coupled weakly, so some twenty steps do, whatever the condition inside a block. In floats, which hold the
// residuals as well: a step is judged by the cost that it leads to, not by its last digits.
#pragma once

#include "fit/tracked_problem.h"

namespace velour {

class TrackedNormal {
 public:
  /// At `x`, with the views' matrices there. Keeps references to `model` and `problem`.
  TrackedNormal(const ParametricBrdf& model, const TrackedProblem& problem, std::vector<LocalNormal> local,
                const Eigen::VectorXd& x);

  /// Solves (H + damping diag H) step = -gradient for the unknowns where `free` is 1; where it is 0 they stay.
  Eigen::VectorXd step(double damping, const Eigen::VectorXd& free) const;
  /// By how much the quadratic model says that a step lowers the cost.
  double promised(const Eigen::VectorXd& step) const;
  /// Half the gradient of the cost.
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  class Preconditioner;
  Eigen::VectorXf product(const Eigen::VectorXf& x) const;
  /// Calls `work(i)` for i in [0, count), views or nodes, on the problem's threads.
  template <class Work>
  void for_each(size_t count, const Work& work) const;

  const ParametricBrdf& model_;
  const TrackedProblem& problem_;
  std::vector<LocalNormal> local_;       // matrices in units of the cost
  std::vector<Eigen::VectorXf> weight_;  // of the taps of all views, [parameter][lobe]
  std::vector<size_t> first_tap_;        // of each view in weight_
  std::vector<Eigen::MatrixXf> block_;   // of each node
  Eigen::VectorXd gradient_;
  Eigen::VectorXf diagonal_;
};

}  // namespace velour
