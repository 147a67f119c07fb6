// The least-squares problem of the parametric model: all views at once, lobes followed over them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "brdf/parametric_brdf.h"
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
  bool guide;                 // only to keep lobes in bounds between samples: its error is nobody's goal
  AlignedFloats residual[3];  // sqrt(weight of the sample) (measured - model)

  TrackedView(const MeasuredSlice& slice, const ViewSpline& spline, double error_goal);
  /// What a sum of squared residuals, channels weighted as in luminance, is worth in the cost.
  double scale() const { return weight / (goal * goal * energy); }
};

// Of the second differences of control values. Against errors in units of their goal it matters only where the data
// leave a value open.
inline constexpr double kSmoothness = 1e-4;

/// Gauss-Newton matrix and half the gradient of a view's squared residuals (channels weighted as in luminance) by the
/// lobes' parameters there, [parameter][lobe].
struct LocalNormal {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

/// cost(x) = sum over the views of weight (error / goal)^2 + kSmoothness x the squared second differences of the
/// control values. The unknowns x are the control values of a model, in its own order (ParametricBrdf::index).
class TrackedProblem {
 public:
  /// `goal` of a view's polar angle (radians). Views without light are left out. `threads` 0: all.
  TrackedProblem(const std::vector<MeasuredSlice>& slices, const ViewSpline& spline,
                 const std::function<double(double)>& goal, int threads, const Progress& progress);

  std::vector<TrackedView>& views() { return views_; }
  const std::vector<TrackedView>& views() const { return views_; }
  int threads() const { return threads_; }
  const Progress& progress() const { return progress_; }

  /// The cost; leaves error and residuals in the views. `model` gives the lobes' spaces and the order of x.
  double evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x);
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
