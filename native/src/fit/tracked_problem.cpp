#include "fit/tracked_problem.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "brdf/held_out.h"
#include "job/parallel.h"

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

constexpr double kChannel[3] = {0.2126, 0.7152, 0.0722};  // shares of the luminance
// The parameters of a shape, in the order of fill_warped_slopes.
constexpr int kShape[kWarpedSlopes] = {P::kLogBandwidth, P::kTiltX, P::kStretchA, P::kTiltY, P::kStretchB};
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

double excess_of(const WarpedShape& shape, const TrackedView& view) {
  if (!view.spacing) return 0;
  const Vec3d center = tilted_normal(shape.tilt_x, shape.tilt_y);
  return std::max(shape.log_bandwidth - view.spacing->most_log_bandwidth(shape.space, center), 0.0);
}

/// One view at one x: the columns of its lobes, then those of their slopes, and the coefficients.
struct Linear {
  ColumnSet columns;
  Eigen::MatrixXd coefficient;  // [lobe][channel]
  Eigen::VectorXd excess;       // of each lobe's log bandwidth

  Linear(const P& model, const Eigen::VectorXd& x, const TrackedView& view, bool slopes)
      : columns(view.samples.padded()) {
    const Index lobes = model.lobe_count();
    const int per_lobe = slopes ? slopes_of(model) : 0;
    const Eigen::MatrixXd parameters = parameters_at(model, x, view.taps);
    columns.resize(static_cast<size_t>(lobes) * static_cast<size_t>(1 + per_lobe));
    excess.resize(lobes);
    for (Index j = 0; j < lobes; ++j) {
      const WarpedShape shape = shape_of(model, parameters, j, view.fade);
      excess[j] = excess_of(shape, view);
      fill_warped(shape, view.wv, view.samples, columns[static_cast<size_t>(j)]);
      if (!slopes) continue;
      float* out[kWarpedSlopes] = {};
      for (int a = 0; a < per_lobe; ++a) out[a] = columns[static_cast<size_t>(lobes + j * per_lobe + a)];
      fill_warped_slopes(shape, view.wv, view.samples, per_lobe, out);
    }
    coefficient = parameters.middleCols(P::kLogRed, 3).array().exp();
  }
};

void leave_residual(const Linear& linear, TrackedView& view) {
  const size_t lobes = static_cast<size_t>(linear.coefficient.rows());
  const auto values = linear.columns.first(lobes);
  double plain = 0, pictures = 0;
  const Eigen::Map<const Eigen::ArrayXf> share(view.share.data(), static_cast<Index>(view.share.size()));
  for (int c = 0; c < 3; ++c) {
    const std::span<const double> coefficients(linear.coefficient.col(c).data(), lobes);
    subtract_columns(values, coefficients, view.samples.target(c), view.samples.padded(), view.residual[c].data());
    const Eigen::Map<const Eigen::ArrayXf> r(view.residual[c].data(), static_cast<Index>(view.residual[c].size()));
    const Eigen::ArrayXd square = r.cast<double>().square();
    plain += kChannel[c] * (square * share.cast<double>()).sum();
    pictures += kChannel[c] * (square * (1 - share).cast<double>()).sum();
  }
  view.error = std::sqrt(plain / view.energy);
  view.picture_error = std::sqrt(pictures / view.picture_share());
  view.excess = linear.excess.squaredNorm();
}

LocalNormal local_normal(const P& model, const Linear& linear, const TrackedView& view) {
  const Index lobes = model.lobe_count();
  const int slopes = slopes_of(model);
  const auto columns = linear.columns.first(static_cast<size_t>(lobes * (1 + slopes)));
  const float* residual[3] = {view.residual[0].data(), view.residual[1].data(), view.residual[2].data()};
  Eigen::MatrixXd products, moments;
  gram(columns, view.samples.padded(), products);
  cross_gram(columns, residual, view.samples.padded(), moments);

  const Eigen::MatrixXd& beta = linear.coefficient;
  Eigen::MatrixXd weighted = beta;  // channel weight x coefficient
  for (int c = 0; c < 3; ++c) weighted.col(c) *= kChannel[c];
  const Eigen::MatrixXd mixed = weighted * beta.transpose();
  LocalNormal out{Eigen::MatrixXf::Zero(model.parameter_count() * lobes, model.parameter_count() * lobes),
                  Eigen::VectorXd::Zero(model.parameter_count() * lobes)};
  const auto slope_row = [&](Index j, int a) { return lobes + j * slopes + a; };
  for (Index j = 0; j < lobes; ++j) {
    for (int a = 0; a < slopes; ++a) {
      const Index row = kShape[a] * lobes + j;
      out.gradient[row] = -moments.row(slope_row(j, a)).dot(weighted.row(j));
      for (Index k = 0; k < lobes; ++k) {
        for (int b = 0; b < slopes; ++b) {
          out.hessian(row, kShape[b] * lobes + k) =
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
  // An excess counts in the cost as it is, the rest by the view's scale.
  for (Index j = 0; j < lobes; ++j) {
    if (!(linear.excess[j] > 0)) continue;
    const Index row = P::kLogBandwidth * lobes + j;
    out.gradient[row] += linear.excess[j] / view.scale();
    out.hessian(row, row) += static_cast<float>(1 / view.scale());
  }
  // The stretch that the view sees is the faded one.
  for (const int p : {static_cast<int>(P::kStretchA), static_cast<int>(P::kStretchB)}) {
    if (p >= model.parameter_count()) continue;
    out.gradient.segment(p * lobes, lobes) *= view.fade;
    out.hessian.middleRows(p * lobes, lobes) *= static_cast<float>(view.fade);
    out.hessian.middleCols(p * lobes, lobes) *= static_cast<float>(view.fade);
  }
  return out;
}

/// Triples of neighbouring nodes whose second difference is to be small.
template <class Use>
void for_each_triple(const ViewSpline& spline, const Use& use) {
  const int side = spline.side();
  const int rows = spline.isotropic() ? 1 : side;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < side; ++x) {
      const int node = y * side + x;
      if (x + 2 < side) use(node, node + 1, node + 2);
      if (y + 2 < rows) use(node, node + side, node + 2 * side);
    }
  }
}

}  // namespace

TrackedView::TrackedView(const MeasuredSlice& slice, const ViewSpline& spline, double error_goal)
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

void TrackedView::weigh_for_pictures() {
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

TrackedProblem::TrackedProblem(const std::vector<MeasuredSlice>& slices, const ViewSpline& spline,
                               const std::function<double(const MeasuredSlice&)>& goal, bool seen_evenly, int threads,
                               const Progress& progress)
    : threads_(threads), progress_(progress) {
  for (const MeasuredSlice& slice : slices) {
    TrackedView view(slice, spline, goal(slice) / std::sqrt(slice.weight));
    if (!(view.energy > 0)) continue;
    // Samples of a goniometer weigh one each, and nobody measured what lies between.
    if (seen_evenly && !slice.interpolated && !(slice.energy > 0)) {
      view.picture_weight = picture_weights(slice.samples);
      view.spacing.emplace(slice.samples, view.wv);
    }
    views_.push_back(std::move(view));
  }
}

double TrackedProblem::cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const {
  double sum = x.dot(smoothness_gradient(model, x));
  for (const TrackedView& v : views_) {
    const double plain = v.error / v.goal, pictures = v.picture_error / kPictureGoal;
    sum += v.weight * plain * plain + pictures * pictures + v.excess;
  }
  return sum;
}

void TrackedProblem::weigh_for_pictures() {
  for (TrackedView& v : views_) v.weigh_for_pictures();
}

TrackedProblem TrackedProblem::remainder() const {
  TrackedProblem out = *this;
  for (TrackedView& v : out.views_) {
    for (int c = 0; c < 3; ++c) v.samples.replace_target(c, v.residual[c]);
  }
  return out;
}

double TrackedProblem::evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x) {
  parallel_pieces(views_.size(), threads_, progress_,
                  [&](size_t i) { leave_residual(Linear(model, x, views_[i], false), views_[i]); });
  return cost(model, x);
}

double TrackedProblem::linearise(const ParametricBrdf& model, const Eigen::VectorXd& x,
                                 std::vector<LocalNormal>& local) {
  local.resize(views_.size());
  parallel_pieces(views_.size(), threads_, progress_, [&](size_t i) {
    const Linear linear(model, x, views_[i], true);
    leave_residual(linear, views_[i]);
    local[i] = local_normal(model, linear, views_[i]);
  });
  return cost(model, x);
}

double error_of(const ParametricBrdf& brdf, const TrackedView& view) {
  const SliceSamples& samples = view.samples;
  const std::vector<WarpedLobe> lobes = lobes_at(brdf, view.wv);
  double sum = 0;
  for (size_t i = 0; i < samples.count(); ++i) {
    const Vec3d wl = samples.wl(i);
    const Vec3d f = brdf.symmetric ? value_of(brdf, wl, view.wv) : value_of(lobes, wl, view.wv);
    for (int c = 0; c < 3; ++c) {
      const double weight = static_cast<double>(samples.sqrt_weight()[i]);
      const double left = weight * wl.z * f[c] - static_cast<double>(samples.target(c)[i]);
      sum += kChannel[c] * left * left * static_cast<double>(view.share[i]);
    }
  }
  return std::sqrt(sum / view.energy);
}

double reported_error(const std::vector<TrackedView>& views, const TrackedView& view) {
  if (view.energy <= view.samples.luminance_energy()) return view.error;
  const auto degrees = [](const TrackedView& v) { return std::atan2(v.wv.x, v.wv.z) * 180 / kPiD; };
  double sum = 0;
  for (const TrackedView& v : views) {
    if (!v.guide && std::abs(degrees(v) - degrees(view)) <= kHeldOutGroup) sum += v.error * v.error * v.energy;
  }
  return std::sqrt(sum / view.energy);
}

Eigen::VectorXd smoothness_gradient(const ParametricBrdf& model, const Eigen::VectorXd& x) {
  const Index block = static_cast<Index>(model.parameter_count()) * model.lobe_count();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  for_each_triple(model.spline(), [&](int a, int b, int c) {
    const Eigen::VectorXd d =
        kSmoothness * (x.segment(a * block, block) - 2 * x.segment(b * block, block) + x.segment(c * block, block));
    out.segment(a * block, block) += d;
    out.segment(b * block, block) -= 2 * d;
    out.segment(c * block, block) += d;
  });
  return out;
}

Eigen::VectorXd spline_through(const std::vector<TrackedView>& views, const ViewSpline& spline,
                               const std::vector<double>& value, bool odd) {
  constexpr double kPull = 1e-3, kRidge = 1e-6;
  const Index nodes = spline.node_count();
  Eigen::MatrixXd a = kRidge * Eigen::MatrixXd::Identity(nodes, nodes);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(nodes);
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewTaps& taps = views[i].taps;
    const double* w = odd ? taps.odd_weight : taps.weight;
    for (int s = 0; s < taps.count; ++s) {
      b[taps.node[s]] += w[s] * value[i];
      for (int t = 0; t < taps.count; ++t) a(taps.node[s], taps.node[t]) += w[s] * w[t];
    }
  }
  for_each_triple(spline, [&](int n0, int n1, int n2) {
    const int node[3] = {n0, n1, n2};
    constexpr double kDifference[3] = {1, -2, 1};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a(node[i], node[j]) += kPull * kDifference[i] * kDifference[j];
    }
  });
  return a.ldlt().solve(b);
}

}  // namespace velour
