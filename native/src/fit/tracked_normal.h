// The damped Gauss-Newton step of the parametric model, without its big matrix.
//
// A view touches three nodes of the spline (nine of a hemisphere's), so the matrix is a sum of small ones, one a view.
// Conjugate gradients with the nodes' own blocks as preconditioner solve it: neighbouring nodes of a quadratic spline
// are coupled weakly, so some twenty steps do, whatever the condition inside a block.
#pragma once

#include "fit/tracked_problem.h"

namespace velour {

/// Which unknowns move.
enum class Free { all, colors };

class TrackedNormal {
 public:
  /// At `x`, with the views' matrices there. Keeps references to `model` and `views`.
  TrackedNormal(const ParametricBrdf& model, const std::vector<TrackedView>& views, std::vector<LocalNormal> local,
                const Eigen::VectorXd& x);

  /// Solves (H + damping diag H) step = -gradient.
  Eigen::VectorXd step(double damping, Free free) const;
  /// Half the gradient of the cost.
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  Eigen::VectorXd product(const Eigen::VectorXd& x, const Eigen::VectorXd& added, const Eigen::VectorXd& mask) const;
  Eigen::VectorXd mask(Free free) const;

  const ParametricBrdf& model_;
  const std::vector<TrackedView>& views_;
  std::vector<LocalNormal> local_;
  std::vector<Eigen::MatrixXd> block_;  // of each node
  Eigen::VectorXd gradient_, diagonal_;
};

}  // namespace velour
