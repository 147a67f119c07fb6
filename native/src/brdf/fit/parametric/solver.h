// Levenberg-Marquardt for the parametric model.
#pragma once

#include "brdf/fit/parametric/problem.h"

namespace velour {

// The damped Gauss-Newton step of the parametric model, without assembling its large matrix.
//
// A view affects three nodes of the spline (nine on a hemisphere), so the matrix is a sum of small ones, one per view.
// Conjugate gradients with the nodes' diagonal blocks as preconditioner solve it. Neighboring nodes of a quadratic
// spline are weakly coupled, so about twenty iterations suffice, whatever the condition of a block. Computed in float,
// like the residuals: a step is judged by the resulting cost, not by its last digits.

class FitNormalEquations {
 public:
  /// `local` are the views' matrices at `x`. Keeps references to `model` and `problem`.
  FitNormalEquations(const ParametricBrdf& model, const FitProblem& problem, std::vector<LocalNormal> local,
                     const Eigen::VectorXd& x);

  /// Solves (H + damping diag H) step = -gradient for the unknowns where `free` is 1; the others stay fixed.
  Eigen::VectorXd step(double damping, const Eigen::VectorXd& free) const;
  /// Decrease of the cost by a step, as predicted by the quadratic model.
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
  const FitProblem& problem_;
  std::vector<LocalNormal> local_;       // matrices in units of the cost
  std::vector<Eigen::VectorXf> weight_;  // tap weights of all views, [parameter][lobe]
  std::vector<size_t> first_tap_;        // first tap of each view in weight_
  std::vector<Eigen::MatrixXf> block_;   // diagonal block of each node
  Eigen::VectorXd gradient_;
  Eigen::VectorXf diagonal_;
};

/// Lobes during a fit: a ParametricBrdf with its control values in double.
struct FitLobes {
  ParametricBrdf model;  // spaces and order; its `control` is empty
  Eigen::VectorXd x;
  double cost = 0;
};

/// Which unknowns move.
enum class Free { all, colors };

/// Takes at most `most` steps, until one lowers the cost by less than `least` of it. Never worse than the start.
/// Deterministic for any thread count.
void refine(FitProblem& problem, FitLobes& lobes, int most, double least, Free free = Free::all);

/// Bounds of the control values of a lobe, all of them half floats. They also bound its parameters at any view.
double lower_bound(int parameter);
double upper_bound(int parameter);

}  // namespace velour
