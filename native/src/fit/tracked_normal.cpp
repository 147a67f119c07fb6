#include "fit/tracked_normal.h"

#include <cmath>
#include <Eigen/Cholesky>

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

// Of the residual in the preconditioner's norm: more digits make no better steps.
constexpr double kRelativeResidual = 3e-3;
constexpr int kMostSteps = 80;
// Of the mean diagonal: what the data leave open must not be singular, nor drift.
constexpr float kRidge = 1e-6f;
// Of a block's diagonal of ones, so that floats can hold its factors.
constexpr float kBlockRidge = 1e-5f;

Index block_size(const P& model) { return static_cast<Index>(model.parameter_count()) * model.lobe_count(); }

/// The weights of a tap, [parameter][lobe].
Eigen::VectorXf tap_weights(const P& model, const ViewTaps& taps, int tap) {
  const Index lobes = model.lobe_count();
  Eigen::VectorXf w = Eigen::VectorXf::Constant(block_size(model), static_cast<float>(taps.weight[tap]));
  w.segment(P::kTiltX * lobes, lobes).setConstant(static_cast<float>(taps.odd_weight[tap]));
  return w;
}

double dot(const Eigen::VectorXf& a, const Eigen::VectorXf& b) { return a.cast<double>().dot(b.cast<double>()); }

}  // namespace

/// The inverse of the nodes' own blocks, each scaled to a diagonal of ones.
class TrackedNormal::Preconditioner {
 public:
  Preconditioner(const std::vector<Eigen::MatrixXf>& blocks, const Eigen::VectorXf& diagonal,
                 const Eigen::VectorXf& added, const Eigen::VectorXf& free)
      : scale_((diagonal + added).cwiseSqrt().cwiseInverse().cwiseProduct(free)) {
    const Index size = blocks.front().rows();
    for (size_t n = 0; n < blocks.size(); ++n) {
      const Index at = static_cast<Index>(n) * size;
      const Eigen::VectorXf scale = scale_.segment(at, size);
      Eigen::MatrixXf m = scale.asDiagonal() * blocks[n] * scale.asDiagonal();
      // What stays is apart from the rest.
      const auto stays = 1 - free.segment(at, size).array();
      m.diagonal().array() += added.segment(at, size).array() * scale.array().square() + kBlockRidge + stays;
      inverse_.emplace_back(m);
    }
  }

  Eigen::VectorXf operator()(const Eigen::VectorXf& r) const {
    Eigen::VectorXf z = r.cwiseProduct(scale_);
    const Index size = z.size() / static_cast<Index>(inverse_.size());
    for (size_t n = 0; n < inverse_.size(); ++n) {
      auto part = z.segment(static_cast<Index>(n) * size, size);
      inverse_[n].solveInPlace(part);
    }
    return z.cwiseProduct(scale_);
  }

 private:
  Eigen::VectorXf scale_;
  std::vector<Eigen::LLT<Eigen::MatrixXf>> inverse_;
};

TrackedNormal::TrackedNormal(const ParametricBrdf& model, const std::vector<TrackedView>& views,
                             std::vector<LocalNormal> local, const Eigen::VectorXd& x)
    : model_(model), views_(views), local_(std::move(local)) {
  const Index block = block_size(model);
  block_.assign(static_cast<size_t>(model.spline().node_count()), Eigen::MatrixXf::Zero(block, block));
  gradient_ = smoothness_gradient(model, x);
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewTaps& taps = views[v].taps;
    local_[v].hessian *= static_cast<float>(views[v].scale());
    for (int t = 0; t < taps.count; ++t) {
      const Eigen::VectorXf w = tap_weights(model, taps, t);
      gradient_.segment(taps.node[t] * block, block) +=
          views[v].scale() * w.cast<double>().cwiseProduct(local_[v].gradient);
      block_[static_cast<size_t>(taps.node[t])] += w.asDiagonal() * local_[v].hessian * w.asDiagonal();
      weight_.push_back(w);
    }
  }
  // The penalty's own diagonal is at most 6 per direction of the grid; small against that of the data where there is
  // any, and a fair scale where there is none.
  diagonal_.resize(gradient_.size());
  for (size_t n = 0; n < block_.size(); ++n) {
    block_[n].diagonal().array() += static_cast<float>(6 * kSmoothness);
    diagonal_.segment(static_cast<Index>(n) * block, block) = block_[n].diagonal();
  }
}

Eigen::VectorXf TrackedNormal::product(const Eigen::VectorXf& x) const {
  const Index block = block_size(model_);
  Eigen::VectorXf out = smoothness_gradient(model_, x.cast<double>()).cast<float>();
  Eigen::VectorXf at_view(block), curved(block);
  auto weight = weight_.begin();
  for (size_t v = 0; v < views_.size(); ++v) {
    const ViewTaps& taps = views_[v].taps;
    at_view.setZero();
    for (int t = 0; t < taps.count; ++t) at_view += weight[t].cwiseProduct(x.segment(taps.node[t] * block, block));
    curved.setZero();
    curved.noalias() += local_[v].hessian * at_view;
    for (int t = 0; t < taps.count; ++t) out.segment(taps.node[t] * block, block) += weight[t].cwiseProduct(curved);
    weight += taps.count;
  }
  return out;
}

Eigen::VectorXd TrackedNormal::step(double damping, const Eigen::VectorXd& free) const {
  const Eigen::VectorXf allowed = free.cast<float>();
  const float ridge = kRidge * diagonal_.mean() + 1e-12f;
  const Eigen::VectorXf added = (static_cast<float>(damping) * diagonal_).array() + ridge;
  const Preconditioner preconditioned(block_, diagonal_, added, allowed);
  Eigen::VectorXf step = Eigen::VectorXf::Zero(gradient_.size());
  Eigen::VectorXf r = -gradient_.cast<float>().cwiseProduct(allowed), z = preconditioned(r), along = z;
  double size = dot(r, z);
  const double enough = kRelativeResidual * kRelativeResidual * size;
  for (int k = 0; k < kMostSteps && size > enough; ++k) {
    const Eigen::VectorXf curved = (product(along) + added.cwiseProduct(along)).cwiseProduct(allowed);
    const double curvature = dot(along, curved);
    if (!(curvature > 0)) break;
    const auto length = static_cast<float>(size / curvature);
    step += length * along;
    r -= length * curved;
    z = preconditioned(r);
    const double next = dot(r, z);
    along = z + static_cast<float>(next / size) * along;
    size = next;
  }
  return step.cast<double>();
}

double TrackedNormal::promised(const Eigen::VectorXd& step) const {
  return -step.dot(2 * gradient_ + product(step.cast<float>()).cast<double>());
}

}  // namespace velour
