#include "brdf/fit/parametric/problem.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "base/parallel.h"
#include "brdf/measure/held_out.h"

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

/// Calls `use` for the triples of neighboring nodes whose second differences are penalized.
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

FitProblem::FitProblem(const std::vector<MeasuredSlice>& slices, const ViewSpline& spline,
                       const std::function<double(const MeasuredSlice&)>& goal, bool seen_evenly, int threads,
                       const Progress& progress)
    : threads_(threads), progress_(progress) {
  for (const MeasuredSlice& slice : slices) {
    FitView view(slice, spline, goal(slice) / std::sqrt(slice.weight));
    if (!(view.energy > 0)) continue;
    if (seen_evenly && slice.lights) {
      view.picture_weight = picture_weights(slice.samples);
      view.spacing.emplace(slice.lights, view.wv);
    }
    if (view.guide) smoothness_ = kSampleSmoothness;
    views_.push_back(std::move(view));
  }
}

double FitProblem::cost(const ParametricBrdf& model, const Eigen::VectorXd& x) const {
  double sum = x.dot(smoothness_gradient(model, smoothness_, x));
  for (const FitView& v : views_) {
    const double plain = v.error / v.goal, pictures = v.picture_error / kPictureGoal;
    sum += v.weight * plain * plain + pictures * pictures + kHiding * v.excess;
  }
  return sum;
}

void FitProblem::weigh_for_pictures() {
  for (FitView& v : views_) v.weigh_for_pictures();
}

FitProblem FitProblem::remainder() const {
  FitProblem out = *this;
  for (FitView& v : out.views_) {
    for (int c = 0; c < 3; ++c) v.samples.replace_target(c, v.residual[c]);
  }
  return out;
}

FitProblem FitProblem::remainder_with(const ParametricBrdf& model, const Eigen::VectorXd& x) const {
  FitProblem out = remainder();
  parallel_pieces(views_.size(), threads_, progress_, [&](size_t i) { add_to_targets(model, x, out.views_[i]); });
  return out;
}

double FitProblem::evaluate(const ParametricBrdf& model, const Eigen::VectorXd& x) {
  parallel_pieces(views_.size(), threads_, progress_, [&](size_t i) { leave_residual(model, x, views_[i]); });
  return cost(model, x);
}

double FitProblem::linearize(const ParametricBrdf& model, const Eigen::VectorXd& x, std::vector<LocalNormal>& local) {
  local.resize(views_.size());
  parallel_pieces(views_.size(), threads_, progress_, [&](size_t i) { local[i] = linearized(model, x, views_[i]); });
  return cost(model, x);
}

double reported_error(const std::vector<FitView>& views, const FitView& view) {
  if (view.energy <= view.samples.luminance_energy()) return view.error;
  const auto degrees = [](const FitView& v) { return std::atan2(v.wv.x, v.wv.z) * 180 / kPiD; };
  double sum = 0;
  for (const FitView& v : views) {
    if (!v.guide && std::abs(degrees(v) - degrees(view)) <= kHeldOutGroup) sum += v.error * v.error * v.energy;
  }
  return std::sqrt(sum / view.energy);
}

Eigen::VectorXd smoothness_gradient(const ParametricBrdf& model, double smoothness, const Eigen::VectorXd& x) {
  const Index block = static_cast<Index>(model.parameter_count()) * model.lobe_count();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  for_each_triple(model.spline(), [&](int a, int b, int c) {
    const Eigen::VectorXd d =
        smoothness * (x.segment(a * block, block) - 2 * x.segment(b * block, block) + x.segment(c * block, block));
    out.segment(a * block, block) += d;
    out.segment(b * block, block) -= 2 * d;
    out.segment(c * block, block) += d;
  });
  return out;
}

Eigen::VectorXd spline_through(const std::vector<FitView>& views, const ViewSpline& spline,
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
