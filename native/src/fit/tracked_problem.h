// The least-squares problem of the parametric model: all views at once, lobes followed over them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "fit/picture_weights.h"
#include "fit/sample_spacing.h"
#include "fit/slice_samples.h"
#include "fit/slice_sampling.h"
#include "fit/warped_columns.h"
#include "job/progress.h"

namespace velour {

// Weight of a guide's squared error.
inline constexpr double kGuideWeight = 0.01;

/// A view of the fit. `error` is the relative L2 of its f cos, channels weighted as in luminance: never below that of
/// the luminance.
struct TrackedView {
  Vec3d wv;
  ViewTaps taps;
  double fade;  // of the stretch
  SliceSamples samples;
  double energy;      // that errors are measured by
  double goal;        // the error wanted
  double weight = 1;  // in the cost
  double error = 1;
  double picture_error = 0;   // the same with picture_weights, once the view is weighed for pictures
  double excess = 0;          // squared, of the lobes' log bandwidths above what the samples can tell
  bool guide;                 // only to keep lobes in bounds between samples: its error is nobody's goal
  AlignedFloats residual[3];  // sqrt(weight of the sample) (measured - model)
  AlignedFloats share;        // of each sample's weight: what it has in `error`, the rest being that of pictures
  std::vector<float> picture_weight;     // none: pictures are not asked for
  std::optional<SampleSpacing> spacing;  // none: any bandwidth will do

  TrackedView(const MeasuredSlice& slice, const ViewSpline& spline, double error_goal);
  /// Adds the picture weights to those of the samples, so that scale() makes weight (error / goal)^2 + (picture_error /
  /// kPictureGoal)^2 of the residuals. To be called again when `weight` changes.
  void weigh_for_pictures();
  /// Picture weight of a sample per plain weight.
  double picture_share() const { return goal * goal * energy / (weight * kPictureGoal * kPictureGoal); }
  /// What a sum of squared residuals, channels weighted as in luminance, is worth in the cost.
  double scale() const { return weight / (goal * goal * energy); }
};

// Of the second differences of control values. Against errors in units of their goal it matters only where the data
// leave a value open.
inline constexpr double kSmoothness = 1e-4;

/// Gauss-Newton matrix and half the gradient of a view's squared residuals (channels weighted as in luminance) by the
/// lobes' parameters there, [parameter][lobe].
struct LocalNormal {
  Eigen::MatrixXf hessian;
  Eigen::VectorXd gradient;
};

/// cost(x) = sum over the views of weight (error / goal)^2 + excess + kSmoothness x the squared second differences of
/// the control values; with weigh_for_pictures() (picture_error / kPictureGoal)^2 of each view as well. The unknowns x
/// are the control values of a model, in its own order (ParametricBrdf::index).
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
  int threads() const { return threads_; }
  const Progress& progress() const { return progress_; }

  /// The cost; leaves error and residuals in the views. `model` gives the lobes' spaces and the order of x.
  double evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x);
  /// The problem of what its lobes leave, as evaluate() or linearise() found it last.
  TrackedProblem remainder() const;
  /// The same for all views, with their matrices.
  double linearise(const ParametricBrdf& model, const Eigen::VectorXd& x, std::vector<LocalNormal>& local);

 private:
  double cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const;

  std::vector<TrackedView> views_;
  int threads_;
  const Progress& progress_;
};

/// TrackedView::error of any model: the scalar reference, symmetric ones included.
double error_of(const ParametricBrdf& brdf, const TrackedView& view);

/// The error of a view as it is reported: of bins that share their energy, all within kHeldOutGroup together.
double reported_error(const std::vector<TrackedView>& views, const TrackedView& view);

/// Half the gradient of the penalty; it is linear in x.
Eigen::VectorXd smoothness_gradient(const ParametricBrdf& model, const Eigen::VectorXd& x);

/// The control values with which a spline of one parameter passes near `value` at the views: least squares with a
/// slight pull to smoothness. `odd`: for what points along the view's azimuth.
Eigen::VectorXd spline_through(const std::vector<TrackedView>& views, const ViewSpline& spline,
                               const std::vector<double>& value, bool odd);

}  // namespace velour
