// The least-squares problem of the parametric model: all views at once, with lobes that vary over them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "brdf/fit/parametric/view.h"
#include "brdf/fit/slice_sampling.h"

namespace velour {

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
  /// The problem whose targets are the residuals of the last evaluate() or linearize().
  FitProblem remainder() const;
  /// remainder() with some of the lobes, those of `x`, added back.
  FitProblem remainder_with(const ParametricBrdf& model, const Eigen::VectorXd& x) const;
  /// Same as evaluate(), and computes the matrices of the views.
  double linearize(const ParametricBrdf& model, const Eigen::VectorXd& x, std::vector<LocalNormal>& local);

 private:
  double cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const;

  std::vector<FitView> views_;
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

}  // namespace velour
