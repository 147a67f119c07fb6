#include "fit/tracked_normal.h"

#include <cmath>
#include <Eigen/Cholesky>

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

constexpr double kRelativeResidual = 1e-4;
constexpr int kMostSteps = 80;
// Of the mean diagonal: what the data leave open must not be singular, nor drift.
constexpr double kRidge = 1e-6;

Index block_size(const P& model) { return static_cast<Index>(model.parameter_count()) * model.lobe_count(); }

/// The weights of a tap, [parameter][lobe].
Eigen::VectorXd tap_weights(const P& model, const ViewTaps& taps, int tap) {
  const Index lobes = model.lobe_count();
  Eigen::VectorXd w = Eigen::VectorXd::Constant(block_size(model), taps.weight[tap]);
  w.segment(P::kTiltX * lobes, lobes).setConstant(taps.odd_weight[tap]);
  return w;
}

}  // namespace

TrackedNormal::TrackedNormal(const ParametricBrdf& model, const std::vector<TrackedView>& views,
                             std::vector<LocalNormal> local, const Eigen::VectorXd& x)
    : model_(model), views_(views), local_(std::move(local)) {
  const Index block = block_size(model);
  block_.assign(static_cast<size_t>(model.spline().node_count()), Eigen::MatrixXd::Zero(block, block));
  gradient_ = smoothness_gradient(model, x);
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewTaps& taps = views[v].taps;
    for (int t = 0; t < taps.count; ++t) {
      const Eigen::VectorXd w = tap_weights(model, taps, t);
      gradient_.segment(taps.node[t] * block, block) += views[v].scale() * w.cwiseProduct(local_[v].gradient);
      block_[static_cast<size_t>(taps.node[t])] +=
          (views[v].scale() * w).asDiagonal() * local_[v].hessian * w.asDiagonal();
    }
  }
  // The penalty's own diagonal is at most 6 per direction of the grid; small against that of the data where there is
  // any, and a fair scale where there is none.
  diagonal_.resize(gradient_.size());
  for (size_t n = 0; n < block_.size(); ++n) {
    block_[n].diagonal().array() += 6 * kSmoothness;
    diagonal_.segment(static_cast<Index>(n) * block, block) = block_[n].diagonal();
  }
}

Eigen::VectorXd TrackedNormal::mask(Free free) const {
  const Index lobes = model_.lobe_count(), block = block_size(model_);
  Eigen::VectorXd m = Eigen::VectorXd::Ones(gradient_.size());
  if (free == Free::all) return m;
  m.setZero();
  for (size_t n = 0; n < block_.size(); ++n) {
    m.segment(static_cast<Index>(n) * block + P::kLogRed * lobes, 3 * lobes).setOnes();
  }
  return m;
}

Eigen::VectorXd TrackedNormal::product(const Eigen::VectorXd& x, const Eigen::VectorXd& added,
                                       const Eigen::VectorXd& mask) const {
  const Index block = block_size(model_);
  Eigen::VectorXd out = smoothness_gradient(model_, x) + added.cwiseProduct(x);
  Eigen::VectorXd at_view(block);
  for (size_t v = 0; v < views_.size(); ++v) {
    const ViewTaps& taps = views_[v].taps;
    at_view.setZero();
    for (int t = 0; t < taps.count; ++t) {
      at_view += tap_weights(model_, taps, t).cwiseProduct(x.segment(taps.node[t] * block, block));
    }
    at_view = views_[v].scale() * (local_[v].hessian * at_view).eval();
    for (int t = 0; t < taps.count; ++t) {
      out.segment(taps.node[t] * block, block) += tap_weights(model_, taps, t).cwiseProduct(at_view);
    }
  }
  return out.cwiseProduct(mask);
}

Eigen::VectorXd TrackedNormal::step(double damping, Free free) const {
  const Index block = block_size(model_);
  const Eigen::VectorXd allowed = mask(free);
  const double ridge = kRidge * diagonal_.mean() + 1e-12;
  const Eigen::VectorXd added = damping * diagonal_ + Eigen::VectorXd::Constant(diagonal_.size(), ridge);
  std::vector<Eigen::LLT<Eigen::MatrixXd>> inverse;
  for (size_t n = 0; n < block_.size(); ++n) {
    const auto here = allowed.segment(static_cast<Index>(n) * block, block);
    Eigen::MatrixXd m = here.asDiagonal() * block_[n] * here.asDiagonal();
    m.diagonal() += added.segment(static_cast<Index>(n) * block, block);
    inverse.emplace_back(m);
  }
  const auto preconditioned = [&](const Eigen::VectorXd& r) {
    Eigen::VectorXd z(r.size());
    for (size_t n = 0; n < inverse.size(); ++n) {
      z.segment(static_cast<Index>(n) * block, block) =
          inverse[n].solve(r.segment(static_cast<Index>(n) * block, block));
    }
    return z.cwiseProduct(allowed).eval();
  };
  Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient_.size());
  Eigen::VectorXd r = -gradient_.cwiseProduct(allowed), z = preconditioned(r), along = z;
  const double enough = kRelativeResidual * kRelativeResidual * r.dot(z);
  double size = r.dot(z);
  for (int k = 0; k < kMostSteps && size > enough; ++k) {
    const Eigen::VectorXd curved = product(along, added, allowed);
    const double length = size / along.dot(curved);
    step += length * along;
    r -= length * curved;
    z = preconditioned(r);
    const double next = r.dot(z);
    along = z + next / size * along;
    size = next;
  }
  return step;
}

}  // namespace velour
