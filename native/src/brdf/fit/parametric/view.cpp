#include "brdf/fit/parametric/view.h"

#include <algorithm>
#include <cmath>

#include "brdf/fit/parametric/warped_columns.h"
#include "brdf/fit/slice_columns.h"

namespace velour {

namespace {

constexpr double kMaxRise = 0.5;  // of the brightest place of a tail above the horizon
constexpr double kMinCenterCosine = 1e-3;
// A lobe on the border of two cells may be far from both samples, and one sample in eight is held out.
constexpr double kCells = 2;

/// Light direction at the center of the lobe. Half vectors that face away from the view have none, so their cosine with
/// it is clamped.
Vec3d light_at_center(const WarpedLobe& lobe, const Vec3d& wv) {
  const Vec3d center = argument_at(lobe, lobe.center);
  if (lobe.space == LobeSpace::light) return center;
  return 2 * std::max(glm::dot(center, wv), kMinCenterCosine) * center - wv;
}

WarpedLobe lobe_of(const WarpedShape& s) {
  return {s.space, stretch_from(s.stretch_a, s.stretch_b), tilted_normal(s.tilt_x, s.tilt_y),
          std::exp(s.log_bandwidth)};
}

Vec3d horizon_under(const Vec3d& wl) {
  const double length = std::hypot(wl.x, wl.y);
  return length > 0 ? Vec3d(wl.x / length, wl.y / length, 0) : Vec3d(1, 0, 0);
}

}  // namespace

/// Decrease of the logarithm of the lobe from the horizon upwards, per radian.
double SampleSpacing::steepness(const WarpedLobe& lobe, const Vec3d& at) const {
  constexpr double kStep = 1e-4;
  const Vec3d above = glm::normalize(at + Vec3d(0, 0, kStep));
  return lobe.bandwidth * glm::dot(warped(lobe, at, wv_) - warped(lobe, above, wv_), lobe.center) / kStep;
}

/// About where f cos of the lobe is largest: at its center or, if that is below the horizon, where the tail above it
/// has fallen to 1 / e.
SampleSpacing::Shown SampleSpacing::shown(const WarpedLobe& lobe) const {
  const Vec3d center = light_at_center(lobe, wv_);
  if (center.z >= 0) return {center, 0};
  const Vec3d horizon = horizon_under(center);
  const double steep = steepness(lobe, horizon);
  return {glm::normalize(horizon + Vec3d(0, 0, steep * kMaxRise > 1 ? 1 / steep : kMaxRise)), steep};
}

double SampleSpacing::log_solid_angle(const WarpedShape& shape) const {
  return std::log(lights_->leaf_at(Vec3(shown(lobe_of(shape)).wl)).solid_angle());
}

double SampleSpacing::excess(const WarpedShape& shape, double log_cell) const {
  const WarpedLobe lobe = lobe_of(shape);
  const Shown at = shown(lobe);
  const double narrow = std::log(kCells * lobe.bandwidth * warp_jacobian(lobe, at.wl, wv_) / (2 * kPiD)) + log_cell;
  return at.steep > 0 ? std::max(narrow, std::log(0.5 * at.steep) + 0.5 * log_cell) : narrow;
}

void SampleSpacing::slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const {
  constexpr double WarpedShape::*kParameter[kWarpedSlopes] = {&WarpedShape::log_bandwidth, &WarpedShape::tilt_x,
                                                              &WarpedShape::stretch_a, &WarpedShape::tilt_y,
                                                              &WarpedShape::stretch_b};
  constexpr double kStep = 1e-5;
  const double log_cell = log_solid_angle(shape);
  for (Eigen::Index a = 0; a < out.size(); ++a) {
    WarpedShape more = shape, less = shape;
    more.*kParameter[a] += kStep;
    less.*kParameter[a] -= kStep;
    out[a] = (excess(more, log_cell) - excess(less, log_cell)) / (2 * kStep);
  }
}

namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

// The parameters of a shape, in the order of fill_warped_slopes.
constexpr int kSlopeParameter[kWarpedSlopes] = {P::kLogBandwidth, P::kTiltX, P::kStretchA, P::kTiltY, P::kStretchB};
constexpr int kColor[3] = {P::kLogRed, P::kLogGreen, P::kLogBlue};

int slopes_of(const P& model) { return model.isotropic ? 3 : kWarpedSlopes; }

double tap_weight(const ViewTaps& taps, int tap, int parameter) {
  return parameter == P::kTiltX ? taps.odd_weight[tap] : taps.weight[tap];
}

/// The parameters of all lobes at one view: [parameter][lobe], as in a node of the control values.
Eigen::MatrixXd parameters_at(const P& model, const Eigen::VectorXd& x, const ViewTaps& taps) {
  const Index lobes = model.lobe_count();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(lobes, model.parameter_count());
  for (int t = 0; t < taps.count; ++t) {
    for (int k = 0; k < model.parameter_count(); ++k) {
      out.col(k) += tap_weight(taps, t, k) * x.segment(static_cast<Index>(model.index(taps.node[t], k, 0)), lobes);
    }
  }
  return out;
}

WarpedShape shape_of(const P& model, const Eigen::MatrixXd& parameters, Index lobe, double fade) {
  WarpedShape s;
  s.space = model.space[static_cast<size_t>(lobe)];
  s.log_bandwidth = parameters(lobe, P::kLogBandwidth);
  s.tilt_x = parameters(lobe, P::kTiltX);
  s.stretch_a = fade * parameters(lobe, P::kStretchA);
  if (!model.isotropic) s.tilt_y = parameters(lobe, P::kTiltY), s.stretch_b = fade * parameters(lobe, P::kStretchB);
  return s;
}

/// One view at one x: the columns of its lobes, then the columns of their slopes, and the coefficients.
struct Linear {
  ColumnSet columns;
  Eigen::MatrixXd coefficient;   // [lobe][channel]
  Eigen::VectorXd excess;        // excess of each lobe's log bandwidth
  Eigen::MatrixXd excess_slope;  // [slope][lobe]; zero without excess

  Linear(const P& model, const Eigen::VectorXd& x, const FitView& view, bool slopes) : columns(view.samples.padded()) {
    const Index lobes = model.lobe_count();
    const int per_lobe = slopes ? slopes_of(model) : 0;
    const Eigen::MatrixXd parameters = parameters_at(model, x, view.taps);
    columns.resize(static_cast<size_t>(lobes) * static_cast<size_t>(1 + per_lobe));
    excess.resize(lobes);
    excess_slope.setZero(per_lobe, lobes);
    for (Index j = 0; j < lobes; ++j) {
      const WarpedShape shape = shape_of(model, parameters, j, view.fade);
      excess[j] = view.spacing ? std::max(view.spacing->excess(shape), 0.0) : 0.0;
      float* const value = columns[static_cast<size_t>(j)];
      if (!slopes) {
        fill_warped(shape, view.wv, view.samples, value);
        continue;
      }
      if (excess[j] > 0) view.spacing->slopes(shape, excess_slope.col(j));
      float* out[kWarpedSlopes] = {};
      for (int a = 0; a < per_lobe; ++a) out[a] = columns[static_cast<size_t>(lobes + j * per_lobe + a)];
      fill_warped_slopes(shape, view.wv, view.samples, per_lobe, value, out);
    }
    coefficient = parameters.middleCols(P::kLogRed, 3).array().exp();
  }
};

/// The view's residual: its targets less `coefficient` times the columns of the lobes.
void subtract_lobes(const Linear& linear, const Eigen::MatrixXd& coefficient, FitView& view) {
  const float* const target[3] = {view.samples.target(0), view.samples.target(1), view.samples.target(2)};
  float* const residual[3] = {view.residual[0].data(), view.residual[1].data(), view.residual[2].data()};
  subtract_columns(linear.columns.first(static_cast<size_t>(coefficient.rows())), coefficient, target,
                   view.samples.padded(), residual);
}

void leave_residual(const Linear& linear, FitView& view) {
  subtract_lobes(linear, linear.coefficient, view);
  double plain = 0, pictures = 0;
  for (int c = 0; c < 3; ++c) {
    const ResidualSums squares = residual_sums(view.residual[c], view.share);
    plain += kLuminance[c] * squares.shared;
    pictures += kLuminance[c] * (squares.all - squares.shared);
  }
  view.error = std::sqrt(plain / view.energy);
  view.picture_error = std::sqrt(std::max(pictures, 0.0) / view.picture_share());
  view.excess = linear.excess.squaredNorm();
}

LocalNormal local_normal(const P& model, const Linear& linear, const FitView& view) {
  const Index lobes = model.lobe_count();
  const int slopes = slopes_of(model);
  const auto columns = linear.columns.first(static_cast<size_t>(lobes * (1 + slopes)));
  const float* residual[3] = {view.residual[0].data(), view.residual[1].data(), view.residual[2].data()};
  Eigen::MatrixXd products, moments;
  gram(columns, view.samples.padded(), products);
  cross_gram(columns, residual, view.samples.padded(), moments);

  const Eigen::MatrixXd& beta = linear.coefficient;
  Eigen::MatrixXd weighted = beta;  // channel weight x coefficient
  for (int c = 0; c < 3; ++c) weighted.col(c) *= kLuminance[c];
  const Eigen::MatrixXd mixed = weighted * beta.transpose();
  LocalNormal out{Eigen::MatrixXf::Zero(model.parameter_count() * lobes, model.parameter_count() * lobes),
                  Eigen::VectorXd::Zero(model.parameter_count() * lobes)};
  const auto slope_row = [&](Index j, int a) { return lobes + j * slopes + a; };
  for (Index j = 0; j < lobes; ++j) {
    for (int a = 0; a < slopes; ++a) {
      const Index row = kSlopeParameter[a] * lobes + j;
      out.gradient[row] = -moments.row(slope_row(j, a)).dot(weighted.row(j));
      for (Index k = 0; k < lobes; ++k) {
        for (int b = 0; b < slopes; ++b) {
          out.hessian(row, kSlopeParameter[b] * lobes + k) =
              static_cast<float>(mixed(j, k) * products(slope_row(j, a), slope_row(k, b)));
        }
        for (int c = 0; c < 3; ++c) {
          const auto entry = static_cast<float>(weighted(j, c) * beta(k, c) * products(slope_row(j, a), k));
          out.hessian(row, kColor[c] * lobes + k) = out.hessian(kColor[c] * lobes + k, row) = entry;
        }
      }
    }
    for (int c = 0; c < 3; ++c) {
      const Index row = kColor[c] * lobes + j;
      out.gradient[row] = -moments(j, c) * weighted(j, c);
      for (Index k = 0; k < lobes; ++k) {
        out.hessian(row, kColor[c] * lobes + k) = static_cast<float>(weighted(j, c) * beta(k, c) * products(j, k));
      }
    }
  }
  // The view's scale later multiplies all of this. It does not apply to the cost of an excess, so it is divided out.
  const double hiding = kHiding / view.scale();
  for (Index j = 0; j < lobes; ++j) {
    const auto slope = linear.excess_slope.col(j);
    for (int a = 0; a < slopes; ++a) {
      const Index row = kSlopeParameter[a] * lobes + j;
      out.gradient[row] += hiding * linear.excess[j] * slope[a];
      for (int b = 0; b < slopes; ++b) {
        out.hessian(row, kSlopeParameter[b] * lobes + j) += static_cast<float>(hiding * slope[a] * slope[b]);
      }
    }
  }
  // Chain rule: the stretch at the view is the control value times the fade.
  for (const int p : {static_cast<int>(P::kStretchA), static_cast<int>(P::kStretchB)}) {
    if (p >= model.parameter_count()) continue;
    out.gradient.segment(p * lobes, lobes) *= view.fade;
    out.hessian.middleRows(p * lobes, lobes) *= static_cast<float>(view.fade);
    out.hessian.middleCols(p * lobes, lobes) *= static_cast<float>(view.fade);
  }
  return out;
}

}  // namespace

FitView::FitView(const MeasuredSlice& slice, const ViewSpline& spline, double error_goal)
    : wv(glm::normalize(Vec3d(slice.wv))),
      taps(spline.at(wv)),
      fade(spline.isotropic() ? pole_fade(wv) : 1.0),
      samples(slice.samples),
      energy(slice.energy > 0 ? slice.energy : samples.luminance_energy()),
      goal(error_goal),
      weight(slice.interpolated ? kGuideWeight : 1.0),
      guide(slice.interpolated),
      share(samples.padded(), 1.0f) {
  for (int c = 0; c < 3; ++c) residual[c].assign(samples.target(c), samples.target(c) + samples.padded());
}

void FitView::weigh_for_pictures() {
  if (picture_weight.empty()) return;
  const auto ratio = static_cast<float>(picture_share());
  std::vector<float> factors(samples.count());
  for (size_t i = 0; i < factors.size(); ++i) {
    const float whole = 1 + ratio * picture_weight[i];
    factors[i] = whole * share[i];
    share[i] = 1 / whole;
  }
  samples.scale_weights(factors);
}

void leave_residual(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view) {
  leave_residual(Linear(model, x, view, false), view);
}

LocalNormal linearized(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view) {
  const Linear linear(model, x, view, true);
  leave_residual(linear, view);
  return local_normal(model, linear, view);
}

void add_to_targets(const ParametricBrdf& model, const Eigen::VectorXd& x, FitView& view) {
  const Linear linear(model, x, view, false);
  subtract_lobes(linear, -linear.coefficient, view);
  for (int c = 0; c < 3; ++c) view.samples.replace_target(c, view.residual[c]);
}

double error_of(const ParametricBrdf& brdf, const FitView& view) {
  const SliceSamples& samples = view.samples;
  const std::vector<WarpedLobe> lobes = lobes_at(brdf, view.wv);
  double sum = 0;
  for (size_t i = 0; i < samples.count(); ++i) {
    const Vec3d wl = samples.wl(i);
    const Vec3d f = brdf.symmetric ? value_of(brdf, wl, view.wv) : value_of(lobes, wl, view.wv);
    for (int c = 0; c < 3; ++c) {
      const double weight = static_cast<double>(samples.sqrt_weight()[i]);
      const double left = weight * wl.z * f[c] - static_cast<double>(samples.target(c)[i]);
      sum += kLuminance[c] * left * left * static_cast<double>(view.share[i]);
    }
  }
  return std::sqrt(sum / view.energy);
}

namespace {

// Luminance relative to the mean below which a sample is invisible beside the light from other directions.
constexpr double kWeightFloor = 0.1;

double luminance_of(const SliceSample& s) { return std::max(static_cast<double>(luminance(s.value)), 0.0); }

}  // namespace

std::vector<float> picture_weights(std::span<const SliceSample> samples) {
  double sum = 0, solid_angle = 0, square = 0;
  for (const SliceSample& s : samples) {
    sum += static_cast<double>(s.weight) * luminance_of(s);
    solid_angle += static_cast<double>(s.weight);
  }
  if (!(sum > 0)) return {};
  const double floor = kWeightFloor * sum / solid_angle;
  std::vector<double> factors;
  for (const SliceSample& s : samples) {
    const double y = luminance_of(s);
    factors.push_back(1 / ((y + floor) * (y + floor)));
    square += static_cast<double>(s.weight) * y * y * factors.back();
  }
  std::vector<float> out;
  for (const double f : factors) out.push_back(static_cast<float>(f / square));
  return out;
}

}  // namespace velour
