// One view of the parametric model's fit: its samples, what the lobes leave of them, and the normal matrix there.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "fit/picture_weights.h"
#include "fit/sample_spacing.h"
#include "fit/slice_samples.h"
#include "fit/slice_sampling.h"

namespace velour {

// Of the squared excess in the cost: what hides between the samples is no part of a fit.
inline constexpr double kHiding = 100;

// Weight of a guide's squared error.
inline constexpr double kGuideWeight = 0.01;

// Weights of the channels in the luminance.
inline constexpr double kLuminanceShare[3] = {0.2126, 0.7152, 0.0722};

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

/// Gauss-Newton matrix and half the gradient of a view's squared residuals (channels weighted as in luminance) by the
/// lobes' parameters there, [parameter][lobe].
struct LocalNormal {
  Eigen::MatrixXf hessian;
  Eigen::VectorXd gradient;
};

/// Leaves error and residuals in the view: of the lobes of `model` with the control values `x`.
void leave_residual(const ParametricBrdf& model, const Eigen::VectorXd& x, TrackedView& view);
/// The same, with the view's matrices.
LocalNormal linearised(const ParametricBrdf& model, const Eigen::VectorXd& x, TrackedView& view);
/// Adds what these lobes give to the view's targets.
void add_to_targets(const ParametricBrdf& model, const Eigen::VectorXd& x, TrackedView& view);

/// TrackedView::error of any model: the scalar reference, symmetric ones included.
double error_of(const ParametricBrdf& brdf, const TrackedView& view);

}  // namespace velour
