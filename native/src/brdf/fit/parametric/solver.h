// The least-squares problem of the parametric model, and Levenberg-Marquardt for it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/parametric/view.h"
#include "brdf/fit/slice_sampling.h"

namespace velour {

// The least-squares problem of the parametric model: all views at once, with lobes that vary over them.

// Weight of the squared second differences of control values. Beside errors in units of their goal, it matters only
// where the data leave a value open: with irregular samples, at most views.
inline constexpr double kSmoothness = 1e-4, kSampleSmoothness = 1e-2;

/// cost(x) = sum over the views of weight (error / goal)^2 + kHiding excess + smoothness() x the squared second
/// differences of the control values; after weigh_for_pictures() also (picture_error / kPictureGoal)^2 of each view.
/// The unknowns x are the control values of a model, in its own order (ParametricBrdf::index).
class FitProblem {
 public:
  /// `goal` returns the error goal of a view. Black views are left out. `threads` 0: all. `seen_evenly`: the weights of
  /// samples of tables are their solid angles alone, which determine the picture weights and the minimum width of
  /// lobes.
  FitProblem(const std::vector<MeasuredSlice>& slices, const ViewSpline& spline,
             const std::function<double(const MeasuredSlice&)>& goal, bool seen_evenly, int threads,
             const Progress& progress);

  std::vector<FitView>& views() { return views_; }
  const std::vector<FitView>& views() const { return views_; }
  /// Adds the picture error to the cost of views with picture weights. To be called again after view weights change.
  void weigh_for_pictures();
  /// Whether the samples determine how narrow a lobe may be. With few irregular ones, freely moving lobes follow noise.
  bool dense() const { return !views_.empty() && views_.front().spacing.has_value(); }
  double smoothness() const { return smoothness_; }
  int threads() const { return threads_; }
  const Progress& progress() const { return progress_; }

  /// Returns the cost; stores errors and residuals in the views. `model` gives the lobes' spaces and the order of x.
  double evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x);
  /// The problem with every second view, if its samples are dense and its views are many for the spline: enough to see
  /// where a lobe belongs.
  FitProblem thinned() const;
  /// The problem whose targets are the residuals of the last evaluate() or linearize().
  FitProblem remainder() const;
  /// remainder() with some of the lobes, those of `x`, added back.
  FitProblem remainder_with(const ParametricBrdf& model, const Eigen::VectorXd& x) const;
  /// Same as evaluate(), and computes the matrices of the views.
  double linearize(const ParametricBrdf& model, const Eigen::VectorXd& x, std::vector<LocalNormal>& local);

 private:
  double cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const;

  std::vector<FitView> views_;
  size_t nodes_;  // of the spline
  double smoothness_ = kSmoothness;
  int threads_;
  const Progress& progress_;
};

/// Error of a view as reported: for bins of irregular samples, that of all bins within kHeldOutGroup together.
double reported_error(const std::vector<FitView>& views, const FitView& view);

/// Half the gradient of `smoothness` x the squared second differences, which is linear in x.
Eigen::VectorXd smoothness_gradient(const ParametricBrdf& model, double smoothness, const Eigen::VectorXd& x);

/// Control values of a spline of one parameter that approximates `value` at the views: least squares with slight
/// smoothing. `odd`: for components along the view's azimuth.
Eigen::VectorXd spline_through(const std::vector<FitView>& views, const ViewSpline& spline,
                               const std::vector<double>& value, bool odd);

// Levenberg-Marquardt for the parametric model.

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
