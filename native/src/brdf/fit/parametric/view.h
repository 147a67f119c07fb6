// One view of the fit of the parametric model: its samples, residuals and normal matrix.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>
#include "brdf/fit/direction_tree.h"
#include "brdf/fit/parametric/warped_columns.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/model/parametric_brdf.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

// Minimum width of a lobe that the samples of a view can resolve.

/// Limits lobes to what the samples of a view, one per cell of a DirectionTree, can resolve.
class SampleSpacing {
 public:
  /// `wv` is unit.
  SampleSpacing(std::shared_ptr<const DirectionTree> lights, const Vec3d& wv) : wv_(wv), lights_(std::move(lights)) {}

  /// Excess of the lobe's log bandwidth over what the samples can resolve; negative for lobes that are wide enough. A
  /// lobe must cover at least twice the solid angle of the cell at its brightest place. If its center is below the
  /// horizon, the tail above must also decay over at least half the spacing of the samples.
  double excess(const WarpedShape& shape) const { return excess(shape, log_solid_angle(shape)); }
  /// Derivatives of excess() by the first out.size() parameters of the shape, in the order of fill_warped_slopes,
  /// within that cell.
  void slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  struct Shown {
    Vec3d wl;
    double steep;  // decay of the tail (1 / rad) if the center is below the horizon, otherwise 0
  };

  Shown shown(const WarpedLobe& lobe) const;
  double log_solid_angle(const WarpedShape& shape) const;
  double excess(const WarpedShape& shape, double log_cell) const;
  double steepness(const WarpedLobe& lobe, const Vec3d& at) const;

  Vec3d wv_;
  std::shared_ptr<const DirectionTree> lights_;
};

// Weights that make the squared error of f cos reflect what pictures show.

/// Target of the relative error of pictures. Half a lightness step on uniform gray is 5 % of its luminance.
inline constexpr double kPictureGoal = 0.1;

/// Factors for the weights of the samples that make a squared error relative to the measurement, for bright and dim
/// samples alike, down to a tenth of the view's mean. A light may show the highlight of a material or only its tail,
/// and eyes see ratios; the squared error of f cos is that of the highlight alone. Scaled so that the weighted squared
/// luminance of the measurement sums to 1. Empty if all samples are black.
std::vector<float> picture_weights(std::span<const SliceSample> samples);

// Weight of the squared excess in the cost, which keeps lobes from hiding between the samples.
inline constexpr double kHiding = 100;

// Weight of the squared error of a guide.
inline constexpr double kGuideWeight = 0.1;

/// A view of the fit. `error` is the relative L2 error of its f cos with channels weighted as in luminance, which is
/// never below that of the luminance.
struct FitView {
  Vec3d wv;
  ViewTaps taps;
  double fade;  // factor of the stretch
  SliceSamples samples;
  double energy;      // energy that errors are relative to
  double goal;        // target of `error`
  double weight = 1;  // weight of the squared error in the cost
  double error = 1;
  double picture_error = 0;   // error with picture weights; 0 before weigh_for_pictures()
  double excess = 0;          // sum over the lobes of the squared SampleSpacing::excess(), if positive
  bool guide;                 // only keeps lobes in bounds between samples; its error is not reported
  AlignedFloats residual[3];  // sqrt(weight of the sample) (measured - model)
  AlignedFloats share;        // share of each sample's weight in `error`; the remainder counts in `picture_error`
  std::vector<float> picture_weight;     // empty: no picture error
  std::optional<SampleSpacing> spacing;  // none: any bandwidth is allowed

  FitView(const MeasuredSlice& slice, const ViewSpline& spline, double error_goal);
  /// Adds the picture weights to those of the samples, so that scale() times the squared residuals is weight (error /
  /// goal)^2 + (picture_error / kPictureGoal)^2. To be called again after `weight` changes.
  void weigh_for_pictures();
  /// Factor that converts picture weights to units of the plain weights.
  double picture_share() const { return goal * goal * energy / (weight * kPictureGoal * kPictureGoal); }
  /// Factor of the sum of squared residuals, channels weighted as in luminance, in the cost.
  double scale() const { return weight / (goal * goal * energy); }
};

/// Gauss-Newton matrix and half the gradient of a view's squared residuals (channels weighted as in luminance) in
/// the lobes' parameters at the view, [parameter][lobe].
struct LocalNormal {
  Eigen::MatrixXf hessian;
  Eigen::VectorXd gradient;
};

/// Stores in the view the error and residuals of the lobes of `model` with the control values `x`.
void leave_residual(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view);
/// Same as leave_residual(), and returns the view's matrices.
LocalNormal linearized(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view);
/// Adds the values of the lobes to the view's targets. Overwrites its residuals.
void add_to_targets(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view);

/// FitView::error of any model, including symmetric ones: the scalar reference.
double error_of(const ParametricBrdf& brdf, const FitView& view);

}  // namespace velour
