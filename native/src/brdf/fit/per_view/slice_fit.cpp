#include "brdf/fit/per_view/slice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <Eigen/Cholesky>

#include "math/optimize/nnls.h"

namespace velour {

namespace {

using Index = Eigen::Index;

// Minimum sharpness: broader lobes are constant over the hemisphere, whatever their center.
constexpr double kMinSharpness = 0.02;
// Maximum ratio of the peak of a lobe below the horizon, which is invisible, to its largest visible value.
constexpr double kMaxPeakBelow = 100;
// Maximum ratio of the peak of a lobe to its value at the nearest sample, which the fit bounds. In the middle of the
// cells of a square grid, the spacing allows the same.
constexpr double kMaxPeakBetween = 4;
// Column products are summed in float; a column below this share of its length is rounding.
constexpr double kSliceRidge = 1e-7;
// Maximum step of one refinement, in lobe widths and in log sharpness.
constexpr double kMaxTurn = 1.0, kMaxLogStep = 1.0;

Vec3d turned(const LobeShape& shape, double along_x, double along_y) {
  const LobeTangents t = lobe_tangents(shape);
  const double width = 1 / std::sqrt(shape.sharpness);
  return glm::normalize(shape.center + width * (along_x * t.x + along_y * t.y));
}

}  // namespace

SliceSolver::SliceSolver(Kernel kernel, const SliceSamples& samples, const Progress& progress)
    : kernel_(kernel),
      samples_(samples),
      progress_(progress),
      state_(samples.padded()),
      trial_(samples.padded()),
      derivatives_(samples.padded()),
      cosine_(samples.padded()) {
  for (size_t i = 0; i < samples.count(); ++i) cosine_[i] = samples.sqrt_weight()[i] * std::max(samples.z()[i], 0.0f);
  solve(state_);
}

void SliceSolver::set_lobes(std::vector<LobeShape> shapes) {
  state_.shapes = std::move(shapes);
  solve(state_);
}

void SliceSolver::add_lobe(const LobeShape& shape) {
  state_.shapes.push_back(shape);
  solve(state_);
}

double SliceSolver::relative_l2() const {
  const Eigen::Vector3d w(kLuminance);
  const double error = std::max(0.0, w.dot(state_.residual_products * w));
  if (samples_.luminance_energy() > 0) return std::sqrt(error / samples_.luminance_energy());
  return error > 0 ? 1.0 : 0.0;
}

std::vector<SliceLobe> SliceSolver::lobes() const {
  std::vector<SliceLobe> out;
  for (int j = 0; j < count(); ++j) {
    const auto peak = state_.peaks.row(j);
    out.push_back({state_.shapes[static_cast<size_t>(j)], {peak[0], peak[1], peak[2]}});
  }
  return out;
}

Vec3d SliceSolver::diffuse() const {
  const auto peak = state_.peaks.row(count());
  return {peak[0], peak[1], peak[2]};
}

double SliceSolver::max_sharpness(const Vec3d& center) const {
  const auto cx = static_cast<float>(center.x), cy = static_cast<float>(center.y), cz = static_cast<float>(center.z);
  float largest = -2, spacing = 1;
  Vec3d nearest(center);
  for (size_t i = 0; i < samples_.count(); ++i) {
    const float t = samples_.x()[i] * cx + samples_.y()[i] * cy + samples_.z()[i] * cz;
    if (t > largest) largest = t, spacing = samples_.sqrt_weight()[i], nearest = Vec3d(samples_.wl(i));
  }
  const double half_width = 0.5 * std::clamp(static_cast<double>(spacing), 1e-4, 1.0);
  const double s = std::sin(0.5 * half_width);
  double limit = std::log(2.0) / (2 * s * s);
  // Only the tail of a lobe below the horizon or in a hole of the data is visible: the peak of a sharp one would be
  // unbounded.
  const double to_nearest = 0.5 * glm::dot(center - nearest, center - nearest);  // 1 - cosine, for small angles too
  if (to_nearest > 0) limit = std::min(limit, std::log(kMaxPeakBetween) / to_nearest);
  if (center.z >= 0) return limit;
  const double cos_depth = std::sqrt(std::max(0.0, 1 - center.z * center.z));
  return std::min(limit, std::log(kMaxPeakBelow) / (1 - cos_depth));
}

/// Columns of the lobes, then of the cosine term.
std::vector<const float*> SliceSolver::columns(const State& state) const {
  auto out = state.values.first(state.shapes.size());
  out.push_back(cosine_.data());
  return out;
}

/// Computes peaks, residual and objective of the shapes.
void SliceSolver::solve(State& state) const {
  const size_t n = state.shapes.size(), padded = samples_.padded();
  state.values.resize(n);
  for (size_t j = 0; j < n; ++j) fill_value(kernel_, state.shapes[j], samples_, state.values[j]);
  const auto all = columns(state);
  Eigen::MatrixXd products, moments;
  gram(all, padded, products);
  const float* const targets[3] = {samples_.target(0), samples_.target(1), samples_.target(2)};
  cross_gram(all, targets, padded, moments);
  if (state.peaks.rows() != static_cast<Index>(n + 1))
    state.peaks = Eigen::MatrixXd::Zero(static_cast<Index>(n + 1), 3);
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd x = state.peaks.col(c);
    solve_nnls(products, moments.col(c), kSliceRidge, x);
    state.peaks.col(c) = x;
  }
  float* const residual[3] = {state.residual[0], state.residual[1], state.residual[2]};
  subtract_columns(all, state.peaks, targets, padded, residual);
  Eigen::MatrixXd residual_products;
  gram(state.residual.first(3), padded, residual_products);
  state.residual_products = residual_products;
  state.objective = 0;
  for (int c = 0; c < 3; ++c) state.objective += kLuminance[c] * residual_products(c, c);
}

/// Adds a channel to the normal equations, eliminating its positive peaks; peaks of 0 stay fixed.
void SliceSolver::eliminate_peaks(const Eigen::MatrixXd& products, int channel, Step& step) const {
  const Index n = count();
  std::vector<Index> term, row;
  for (Index j = 0; j <= n; ++j) {
    if (!(state_.peaks(j, channel) > 0)) continue;
    term.push_back(j);
    for (Index a = 0; a < 3 && j < n; ++a) row.push_back(3 * j + a);
  }
  if (row.empty()) return;
  std::vector<Index> derivative;
  for (const Index r : row) derivative.push_back(n + 1 + r);
  Eigen::MatrixXd values = products(term, term);
  values.diagonal() *= 1 + kSliceRidge;
  const Eigen::MatrixXd mixed = products(term, derivative);
  const Eigen::MatrixXd own = products(derivative, derivative);
  const Eigen::MatrixXd reduced = own - mixed.transpose() * values.ldlt().solve(mixed);
  const double weight = kLuminance[channel];
  for (size_t p = 0; p < row.size(); ++p) {
    const double peak_p = weight * state_.peaks(row[p] / 3, channel);
    step.scale[row[p]] +=
        peak_p * state_.peaks(row[p] / 3, channel) * own(static_cast<Index>(p), static_cast<Index>(p));
    for (size_t q = 0; q < row.size(); ++q) {
      step.normal(row[p], row[q]) +=
          peak_p * state_.peaks(row[q] / 3, channel) * reduced(static_cast<Index>(p), static_cast<Index>(q));
    }
  }
}

SliceSolver::Step SliceSolver::linearize() {
  const size_t n = state_.shapes.size();
  derivatives_.resize(3 * n);
  for (size_t j = 0; j < n; ++j) {
    fill_derivatives(kernel_, state_.shapes[j], samples_, derivatives_[3 * j], derivatives_[3 * j + 1],
                     derivatives_[3 * j + 2]);
  }
  auto all = columns(state_);
  const auto derivatives = derivatives_.first(3 * n);
  all.insert(all.end(), derivatives.begin(), derivatives.end());
  Eigen::MatrixXd products, slopes;
  gram(all, samples_.padded(), products);
  cross_gram(derivatives, state_.residual.first(3), samples_.padded(), slopes);

  const auto unknowns = static_cast<Index>(3 * n);
  Step step{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns),
            Eigen::VectorXd::Zero(unknowns)};
  for (int c = 0; c < 3; ++c) {
    eliminate_peaks(products, c, step);
    for (Index r = 0; r < unknowns; ++r) {
      step.slope[r] += kLuminance[c] * state_.peaks(r / 3, c) * slopes(r, c);
    }
  }
  // Both tangents share one scale, so that the step does not depend on their rotation about the center.
  for (Index j = 0; j < unknowns; j += 3) {
    step.scale[j] = step.scale[j + 1] = 0.5 * (step.scale[j] + step.scale[j + 1]);
  }
  step.scale.array() += 1e-12 * step.scale.maxCoeff() + 1e-300;
  return step;
}

std::vector<LobeShape> SliceSolver::moved(const Eigen::VectorXd& by) const {
  std::vector<LobeShape> out = state_.shapes;
  for (size_t j = 0; j < out.size(); ++j) {
    const auto r = static_cast<Index>(3 * j);
    const double turn = std::hypot(by[r], by[r + 1]);
    const double shorten = turn > kMaxTurn ? kMaxTurn / turn : 1.0;
    const double log_step = std::clamp(by[r + 2], -kMaxLogStep, kMaxLogStep);
    const Vec3d center = turned(out[j], shorten * by[r], shorten * by[r + 1]);
    const double sharpness = out[j].sharpness * std::exp(log_step);
    out[j] = {center, std::max(kMinSharpness, std::min(sharpness, max_sharpness(center)))};
  }
  return out;
}

void SliceSolver::refine(int steps, double goal, double least_gain) {
  double damping = 1e-2, growth = 2;
  Step step;
  bool fresh = false;
  for (int k = 0; k < steps && count() > 0 && relative_l2() > goal; ++k) {
    progress_.check();
    if (!fresh) step = linearize();
    fresh = true;
    Eigen::MatrixXd damped = step.normal;
    damped.diagonal() += damping * step.scale;
    const Eigen::VectorXd by = damped.ldlt().solve(step.slope);
    if (!by.allFinite()) return;
    trial_.shapes = moved(by);
    trial_.peaks = state_.peaks;
    solve(trial_);
    const double gain = state_.objective - trial_.objective;
    if (!(gain > 0)) {
      damping *= growth;
      growth *= 2;
      if (damping > 1e8) return;
      continue;
    }
    const double promised = by.dot(step.slope) + damping * by.dot(step.scale.cwiseProduct(by));
    const double ratio = promised > 0 ? gain / promised : 1.0;
    // Nielsen's rule (1999): the damping depends on how well the linear model predicted the gain.
    damping = std::max(1e-9, damping * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3.0)));
    growth = 2;
    const bool slow = gain < least_gain * state_.objective;
    std::swap(state_, trial_);
    fresh = false;
    if (slow) return;
  }
}

namespace {

constexpr size_t kCoarseStride = 8;  // candidates and their scores use one sample in eight
constexpr double kFirstSharpness = 0.5, kSharpnessRatio = 2.5, kNarrow = 60;
constexpr int kStepsPerLobe = 4, kFinalSteps = 40;

/// One sample in kCoarseStride, for the search for the next lobe.
std::vector<SliceSample> coarse_samples(const SliceSamples& samples) {
  std::vector<SliceSample> out;
  for (size_t i = 0; i < samples.count(); i += kCoarseStride) {
    const float q = samples.sqrt_weight()[i] * samples.sqrt_weight()[i];
    out.push_back({Vec3(samples.wl(i)), q * kCoarseStride, Rgb(0)});
  }
  return out;
}

/// The residual of a solver of `samples` at the coarse samples, and the maximum sharpness of lobes at their centers.
class CoarseResidual {
 public:
  CoarseResidual(const SliceSamples& samples, const SliceSolver& solver) : samples_(coarse_samples(samples)) {
    for (AlignedFloats& r : residual_) r.assign(samples_.padded(), 0.0f);
    for (size_t i = 0; i < samples_.count(); ++i) max_sharpness_.push_back(solver.max_sharpness(center(i)));
  }
  void take(const SliceSolver& solver) {
    const float scale = std::sqrt(static_cast<float>(kCoarseStride));
    for (int c = 0; c < 3; ++c) {
      AlignedFloats& r = residual_[static_cast<size_t>(c)];
      for (size_t i = 0; i < samples_.count(); ++i) r[i] = scale * solver.residual(c)[i * kCoarseStride];
    }
    brightest_ = 0;
    for (size_t i = 0; i < samples_.count(); ++i) brightest_ = std::max(brightest_, luminance_at(i));
  }
  /// Whether a narrow lobe there may gain as much as elsewhere.
  bool is_bright(size_t i) const { return luminance_at(i) >= kDim * brightest_; }
  /// Decrease of E if a single lobe of this shape is fitted to the residual.
  double gain(Kernel kernel, const LobeShape& shape) const {
    const float* const r[3] = {residual_[0].data(), residual_[1].data(), residual_[2].data()};
    const Projection p = project(kernel, shape, samples_, r);
    double gain = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double moment = std::max(0.0, p.moment[c]);
      gain += kLuminance[c] * moment * moment;
    }
    return gain / std::max(p.norm_sq, 1e-30);
  }
  size_t count() const { return samples_.count(); }
  Vec3d center(size_t i) const { return glm::normalize(samples_.wl(i)); }
  double max_sharpness(size_t i) const { return max_sharpness_[i]; }

 private:
  /// Luminance of what the solver lacks.
  double luminance_at(size_t i) const {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) sum += kLuminance[c] * std::max(0.0, static_cast<double>(residual_[c][i]));
    return sum;
  }

  static constexpr double kDim = 0.2;
  SliceSamples samples_;
  std::vector<double> max_sharpness_;
  std::array<AlignedFloats, 3> residual_;
  double brightest_ = 0;
};

/// The best single lobe for the residual: the maximum of the residual smoothed at every scale.
LobeShape best_candidate(Kernel kernel, const CoarseResidual& coarse, const Progress& progress) {
  LobeShape best;
  double most = -1;
  for (size_t i = 0; i < coarse.count(); ++i) {
    if (i % 32 == 0) progress.check();
    const Vec3d center = coarse.center(i);
    for (double k = kFirstSharpness; k <= coarse.max_sharpness(i); k *= kSharpnessRatio) {
      // A broad lobe does not need a fine grid of centers, and a narrow one gains only what is at its center.
      if (k < 10 && i % 8 != 0) continue;
      if (k > kNarrow && !coarse.is_bright(i)) break;
      const double gain = coarse.gain(kernel, {center, k});
      if (gain > most) most = gain, best = {center, k};
    }
  }
  return best;
}

SliceFit snapshot(const SliceSolver& solver) { return {solver.lobes(), solver.diffuse(), solver.relative_l2()}; }

}  // namespace

std::vector<SliceFit> fit_slice(const SliceSamples& samples, const SliceFitOptions& options, const Progress& progress) {
  SliceSolver solver(options.kernel, samples, progress);
  std::vector<SliceFit> path{snapshot(solver)};
  if (samples.count() == 0 || !(samples.luminance_energy() > 0)) return path;
  CoarseResidual coarse(samples, solver);
  for (int j = 1; j <= options.max_lobes && path.back().relative_l2 > options.goal; ++j) {
    coarse.take(solver);
    solver.add_lobe(best_candidate(options.kernel, coarse, progress));
    const bool last = j == options.max_lobes;
    solver.refine(last ? kFinalSteps : kStepsPerLobe, options.goal, last ? 1e-4 : 1e-3);
    path.push_back(solver.relative_l2() < path.back().relative_l2 ? snapshot(solver) : path.back());
  }
  return path;
}

namespace {

/// b of Abel-Poisson from 2/3 k = 2 b / (1 - b)^2, in a form without cancellation.
double abel_poisson_bandwidth(double sharpness) {
  const double c = 2.0 / 3.0 * sharpness;
  return c / (c + 1 + std::sqrt(2 * c + 1));
}

}  // namespace

StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe) {
  double bandwidth = lobe.shape.sharpness;
  if (kernel == Kernel::abel_poisson) {
    // The largest float below 1 would make the kernel a spike; this bound is sharper than any grid of lights resolves.
    bandwidth = std::min(abel_poisson_bandwidth(lobe.shape.sharpness), 1 - 1e-6);
  }
  const auto rounded = static_cast<float>(bandwidth);
  const double peak = kernel_value(kernel, rounded, 0);
  return {Vec3(lobe.shape.center), rounded, Rgb(lobe.peak / peak)};
}

}  // namespace velour
