// The least-squares problem of the parametric model: all views at once, lobes followed over them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fit/slice_sampling.h"
#include "fit/tracked_view.h"
#include "job/progress.h"

namespace velour {

// Of the second differences of control values. Against errors in units of their goal it matters only where the data
// leave a value open.
inline constexpr double kSmoothness = 1e-4;

/// cost(x) = sum over the views of weight (error / goal)^2 + kHiding excess + kSmoothness x the squared second
/// differences of the control values; with weigh_for_pictures() (picture_error / kPictureGoal)^2 of each view as well.
/// The unknowns x are the control values of a model, in its own order (ParametricBrdf::index).
class TrackedProblem {
 public:
  /// `goal` of a view. Views without light are left out. `threads` 0: all. `seen_evenly`: the
  /// samples of tables weigh their solid angle and no more, so that what pictures show can be told from it, and how
  /// narrow a lobe may be.
  TrackedProblem(const std::vector<MeasuredSlice>& slices, const ViewSpline& spline,
                 const std::function<double(const MeasuredSlice&)>& goal, bool seen_evenly, int threads,
                 const Progress& progress);

  std::vector<TrackedView>& views() { return views_; }
  const std::vector<TrackedView>& views() const { return views_; }
  /// From now on; again after weights of views have changed. Nothing happens to views that know no picture weights.
  void weigh_for_pictures();
  /// Whether samples tell how narrow a lobe may be; of few irregular ones, lobes that are free to search follow noise.
  bool dense() const { return !views_.empty() && views_.front().spacing.has_value(); }
  int threads() const { return threads_; }
  const Progress& progress() const { return progress_; }

  /// The cost; leaves error and residuals in the views. `model` gives the lobes' spaces and the order of x.
  double evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x);
  /// The problem of what its lobes leave, as evaluate() or linearise() found it last.
  TrackedProblem remainder() const;
  /// The same with what the lobes of `x`, some of them, gave.
  TrackedProblem remainder_with(const ParametricBrdf& model, const Eigen::VectorXd& x) const;
  /// The same for all views, with their matrices.
  double linearise(const ParametricBrdf& model, const Eigen::VectorXd& x, std::vector<LocalNormal>& local);

 private:
  double cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const;

  std::vector<TrackedView> views_;
  int threads_;
  const Progress& progress_;
};

/// The error of a view as it is reported: of bins that share their energy, all within kHeldOutGroup together.
double reported_error(const std::vector<TrackedView>& views, const TrackedView& view);

/// Half the gradient of the penalty; it is linear in x.
Eigen::VectorXd smoothness_gradient(const ParametricBrdf& model, const Eigen::VectorXd& x);

/// The control values with which a spline of one parameter passes near `value` at the views: least squares with a
/// slight pull to smoothness. `odd`: for what points along the view's azimuth.
Eigen::VectorXd spline_through(const std::vector<TrackedView>& views, const ViewSpline& spline,
                               const std::vector<double>& value, bool odd);

}  // namespace velour
