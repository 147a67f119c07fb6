#include "brdf/fit/parametric/solver.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "base/parallel.h"
#include "brdf/measure/held_out.h"
#include "math/tensor/matrix_product.h"

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
    : nodes_(static_cast<size_t>(spline.node_count())), threads_(threads), progress_(progress) {
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

FitProblem FitProblem::thinned() const {
  constexpr double kViewsPerNode = 2.5;
  if (!dense() || static_cast<double>(views_.size()) < kViewsPerNode * static_cast<double>(nodes_)) return *this;
  FitProblem out = *this;
  out.views_.clear();
  for (size_t i = 0; i < views_.size(); i += 2) out.views_.push_back(views_[i]);
  return out;
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

namespace {

constexpr double kFirstDamping = 1e-3, kMinDamping = 1e-6;
constexpr double kFastestFall = 0.2, kSlowestRise = 2;  // bounds of the factor of the damping after an accepted step
constexpr int kTrials = 6;
constexpr double kMaxStep = 1;  // maximum change of a control value: a factor of e, or a radian

int parameter_of(const P& model, Index i) { return static_cast<int>(i / model.lobe_count()) % model.parameter_count(); }

Eigen::VectorXd stepped(const FitLobes& lobes, const Eigen::VectorXd& step) {
  Eigen::VectorXd x = lobes.x;
  for (Index i = 0; i < x.size(); ++i) {
    const int p = parameter_of(lobes.model, i);
    x[i] = std::clamp(x[i] + std::clamp(step[i], -kMaxStep, kMaxStep), lower_bound(p), upper_bound(p));
  }
  return x;
}

/// 1 for unknowns that may move, otherwise 0. Unknowns at a bound that a step would cross are held, because the step of
/// the others would rely on a move that the bound prevents.
Eigen::VectorXd free_to_move(const FitLobes& lobes, const Eigen::VectorXd& gradient, Free free) {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(lobes.x.size());
  for (Index i = 0; i < out.size(); ++i) {
    const int p = parameter_of(lobes.model, i);
    const bool color = p >= P::kLogRed && p <= P::kLogBlue;
    const bool held =
        (lobes.x[i] <= lower_bound(p) && gradient[i] > 0) || (lobes.x[i] >= upper_bound(p) && gradient[i] < 0);
    if (held || (free == Free::colors && !color)) out[i] = 0;
  }
  return out;
}

/// Damping of a step, adapted by the ratio of actual to predicted gain of earlier steps [Nie99].
class Damping {
 public:
  double value() const { return value_; }
  void taken(double share) {
    const double factor = 1 - std::pow(2 * share - 1, 3);
    value_ = std::max(value_ * std::clamp(factor, kFastestFall, kSlowestRise), kMinDamping);
    rise_ = kFirstRise;
  }
  void refused() {
    value_ *= rise_;
    rise_ *= 2;
  }

 private:
  static constexpr double kFirstRise = 4;
  double value_ = kFirstDamping, rise_ = kFirstRise;
};

}  // namespace

double lower_bound(int parameter) {
  switch (parameter) {
    case P::kLogBandwidth:
      return -4;
    case P::kTiltX:
    case P::kTiltY:
      return -1.875;
    case P::kStretchA:
    case P::kStretchB:
      return -2.5;
    default:
      return -25;
  }
}

double upper_bound(int parameter) {
  switch (parameter) {
    case P::kLogBandwidth:
      return 16;
    case P::kTiltX:
    case P::kTiltY:
      return 1.875;
    case P::kStretchA:
    case P::kStretchB:
      return 2.5;
    default:
      return 16;
  }
}

void refine(FitProblem& problem, FitLobes& lobes, int most, double least, Free free) {
  Damping damping;
  std::vector<LocalNormal> local;
  for (int step = 0; step < most; ++step) {
    lobes.cost = problem.linearize(lobes.model, lobes.x, local);
    const FitNormalEquations normal(lobes.model, problem, std::move(local), lobes.x);
    const Eigen::VectorXd moving = free_to_move(lobes, normal.gradient(), free);
    const double before = lobes.cost;
    for (int trial = 0; trial < kTrials && lobes.cost == before; ++trial) {
      const Eigen::VectorXd x = stepped(lobes, normal.step(damping.value(), moving));
      const double cost = problem.evaluate(lobes.model, x);
      if (cost < before) {
        damping.taken((before - cost) / std::max(normal.promised(x - lobes.x), 1e-12 * before));
        lobes.x = x, lobes.cost = cost;
      } else {
        damping.refused();
      }
    }
    if (before - lobes.cost < least * before) break;
  }
  // Errors and residuals of the result, not of the last trial.
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

namespace {

// Relative residual, in the preconditioner's norm, at which conjugate gradients stop. Steps are judged by the cost that
// they lead to; more digits cost iterations and do not improve fits.
constexpr double kRelativeResidual = 0.1;
constexpr int kMaxSteps = 80;
// Ridge relative to the mean diagonal, so that what the data leave open is not singular and does not drift.
constexpr float kNormalRidge = 1e-6f;
// Ridge relative to a block's unit diagonal, so that it can be factored in float.
constexpr float kBlockRidge = 1e-5f;
// Matrices with at least this many rows are processed in parallel, in this many chunks.
constexpr Index kMinShared = 32;
constexpr size_t kRuns = 8;

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

/// Inverse of the nodes' diagonal blocks, each scaled to a unit diagonal.
class FitNormalEquations::Preconditioner {
 public:
  Preconditioner(const FitNormalEquations& normal, const Eigen::VectorXf& added, const Eigen::VectorXf& free)
      : normal_(normal),
        scale_((normal.diagonal_ + added).cwiseSqrt().cwiseInverse().cwiseProduct(free)),
        inverse_(normal.block_.size()) {
    const Index size = normal.block_.front().rows();
    normal.for_each(inverse_.size(), [&](size_t n) {
      const Index at = static_cast<Index>(n) * size;
      const Eigen::VectorXf scale = scale_.segment(at, size);
      Eigen::MatrixXf m = scale.asDiagonal() * normal.block_[n] * scale.asDiagonal();
      // Fixed unknowns are decoupled from the others.
      const auto stays = 1 - free.segment(at, size).array();
      m.diagonal().array() += added.segment(at, size).array() * scale.array().square() + kBlockRidge + stays;
      inverse_[n].compute(m);
    });
  }

  Eigen::VectorXf operator()(const Eigen::VectorXf& r) const {
    Eigen::VectorXf z = r.cwiseProduct(scale_);
    const Index size = z.size() / static_cast<Index>(inverse_.size());
    normal_.for_each(inverse_.size(), [&](size_t n) {
      auto part = z.segment(static_cast<Index>(n) * size, size);
      inverse_[n].solveInPlace(part);
    });
    return z.cwiseProduct(scale_);
  }

 private:
  const FitNormalEquations& normal_;
  Eigen::VectorXf scale_;
  std::vector<Eigen::LLT<Eigen::MatrixXf>> inverse_;
};

template <class Work>
void FitNormalEquations::for_each(size_t count, const Work& work) const {
  const Index block = block_size(model_);
  const size_t runs = block < kMinShared ? 1 : std::min(kRuns, count);
  parallel_pieces(runs, problem_.threads(), problem_.progress(), [&](size_t run) {
    for (size_t i = run * count / runs; i < (run + 1) * count / runs; ++i) work(i);
  });
}

FitNormalEquations::FitNormalEquations(const ParametricBrdf& model, const FitProblem& problem,
                                       std::vector<LocalNormal> local, const Eigen::VectorXd& x)
    : model_(model), problem_(problem), local_(std::move(local)) {
  const std::vector<FitView>& views = problem.views();
  const Index block = block_size(model);
  block_.assign(static_cast<size_t>(model.spline().node_count()), Eigen::MatrixXf::Zero(block, block));
  gradient_ = smoothness_gradient(model, problem.smoothness(), x);
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewTaps& taps = views[v].taps;
    local_[v].hessian *= static_cast<float>(views[v].scale());
    first_tap_.push_back(weight_.size());
    for (int t = 0; t < taps.count; ++t) {
      const Eigen::VectorXf w = tap_weights(model, taps, t);
      gradient_.segment(taps.node[t] * block, block) +=
          views[v].scale() * w.cast<double>().cwiseProduct(local_[v].gradient);
      block_[static_cast<size_t>(taps.node[t])] += w.asDiagonal() * local_[v].hessian * w.asDiagonal();
      weight_.push_back(w);
    }
  }
  // The diagonal of the penalty is at most 6 per direction of the grid: small compared with that of the data, and a
  // fair scale where there are no data.
  diagonal_.resize(gradient_.size());
  for (size_t n = 0; n < block_.size(); ++n) {
    block_[n].diagonal().array() += static_cast<float>(6 * problem.smoothness());
    diagonal_.segment(static_cast<Index>(n) * block, block) = block_[n].diagonal();
  }
}

Eigen::VectorXf FitNormalEquations::product(const Eigen::VectorXf& x) const {
  const std::vector<FitView>& views = problem_.views();
  const Index block = block_size(model_);
  Eigen::MatrixXf curved(block, static_cast<Index>(views.size()));
  for_each(views.size(), [&](size_t v) {
    const ViewTaps& taps = views[v].taps;
    const Eigen::VectorXf* weight = &weight_[first_tap_[v]];
    Eigen::VectorXf at_view = Eigen::VectorXf::Zero(block);
    for (int t = 0; t < taps.count; ++t) at_view += weight[t].cwiseProduct(x.segment(taps.node[t] * block, block));
    multiply({local_[v].hessian.data(), block, block, 1, block}, at_view.data(),
             curved.col(static_cast<Index>(v)).data());
  });
  Eigen::VectorXf out = smoothness_gradient(model_, problem_.smoothness(), x.cast<double>()).cast<float>();
  auto weight = weight_.begin();
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewTaps& taps = views[v].taps;
    for (int t = 0; t < taps.count; ++t) {
      out.segment(taps.node[t] * block, block) += (weight++)->cwiseProduct(curved.col(static_cast<Index>(v)));
    }
  }
  return out;
}

Eigen::VectorXd FitNormalEquations::step(double damping, const Eigen::VectorXd& free) const {
  const Eigen::VectorXf allowed = free.cast<float>();
  const float ridge = kNormalRidge * diagonal_.mean() + 1e-12f;
  const Eigen::VectorXf added = (static_cast<float>(damping) * diagonal_).array() + ridge;
  const Preconditioner preconditioned(*this, added, allowed);
  Eigen::VectorXf step = Eigen::VectorXf::Zero(gradient_.size());
  Eigen::VectorXf r = -gradient_.cast<float>().cwiseProduct(allowed), z = preconditioned(r), along = z;
  double size = dot(r, z);
  const double enough = kRelativeResidual * kRelativeResidual * size;
  for (int k = 0; k < kMaxSteps && size > enough; ++k) {
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

double FitNormalEquations::promised(const Eigen::VectorXd& step) const {
  return -step.dot(2 * gradient_ + product(step.cast<float>()).cast<double>());
}

}  // namespace velour
