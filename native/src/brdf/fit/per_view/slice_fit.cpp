#include "brdf/fit/per_view/slice_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace velour {

namespace {

constexpr size_t kCoarseStride = 8;  // candidates and their scores use one sample in eight
constexpr double kFirstSharpness = 0.5, kSharpnessRatio = 2.5;
constexpr int kStepsPerLobe = 8, kFinalSteps = 40, kSwapRounds = 6;

/// One sample in kCoarseStride, for the search for the next lobe.
std::vector<SliceSample> coarse_samples(const SliceSamples& samples) {
  std::vector<SliceSample> out;
  for (size_t i = 0; i < samples.count(); i += kCoarseStride) {
    const float q = samples.sqrt_weight()[i] * samples.sqrt_weight()[i];
    out.push_back({Vec3(samples.wl(i)), q * kCoarseStride, Rgb(0)});
  }
  return out;
}

/// The residual of the solver at the coarse samples.
class CoarseResidual {
 public:
  explicit CoarseResidual(const SliceSamples& samples) : samples_(coarse_samples(samples)) {
    for (AlignedFloats& r : residual_) r.assign(samples_.padded(), 0.0f);
  }
  void take(const SliceSolver& solver) {
    const float scale = std::sqrt(static_cast<float>(kCoarseStride));
    for (int c = 0; c < 3; ++c) {
      AlignedFloats& r = residual_[static_cast<size_t>(c)];
      for (size_t i = 0; i < samples_.count(); ++i) r[i] = scale * solver.residual(c)[i * kCoarseStride];
    }
  }
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
  const SliceSamples& samples() const { return samples_; }

 private:
  SliceSamples samples_;
  std::array<AlignedFloats, 3> residual_;
};

/// The best single lobe for the residual: the maximum of the residual smoothed at every scale.
LobeShape best_candidate(const SliceSolver& solver, Kernel kernel, const CoarseResidual& coarse,
                         const Progress& progress) {
  LobeShape best;
  double most = -1;
  const SliceSamples& centers = coarse.samples();
  for (size_t i = 0; i < centers.count(); ++i) {
    if (i % 32 == 0) progress.check();
    const Vec3d center = glm::normalize(centers.wl(i));
    const double limit = solver.max_sharpness(center);
    for (double k = kFirstSharpness; k <= limit; k *= kSharpnessRatio) {
      // A broad lobe does not need a fine grid of centers.
      if (k < 10 && i % 8 != 0) continue;
      const double gain = coarse.gain(kernel, {center, k});
      if (gain > most) most = gain, best = {center, k};
    }
  }
  return best;
}

SliceFit snapshot(const SliceSolver& solver) { return {solver.lobes(), solver.diffuse(), solver.relative_l2()}; }

std::vector<LobeShape> without(const std::vector<LobeShape>& shapes, int removed) {
  std::vector<LobeShape> out = shapes;
  out.erase(out.begin() + removed);
  return out;
}

}  // namespace

std::vector<SliceFit> fit_slice(const SliceSamples& samples, const SliceFitOptions& options, const Progress& progress) {
  SliceSolver solver(options.kernel, samples, progress);
  std::vector<SliceFit> path{snapshot(solver)};
  if (samples.count() == 0 || !(samples.luminance_energy() > 0)) return path;
  CoarseResidual coarse(samples);
  for (int j = 1; j <= options.max_lobes && path.back().relative_l2 > options.goal; ++j) {
    coarse.take(solver);
    solver.add_lobe(best_candidate(solver, options.kernel, coarse, progress));
    const bool last = j == options.max_lobes;
    solver.refine(last ? kFinalSteps : kStepsPerLobe, options.goal, last ? 1e-4 : 1e-3);
    path.push_back(solver.relative_l2() < path.back().relative_l2 ? snapshot(solver) : path.back());
  }
  // At max_lobes and short of the goal: move the least important lobe to where it gains most.
  for (int round = 0; round < kSwapRounds && path.back().relative_l2 > options.goal && solver.count() > 1; ++round) {
    const auto before = solver.shapes();
    const double objective = solver.objective();
    solver.set_lobes(without(before, solver.least_important()));
    coarse.take(solver);
    solver.add_lobe(best_candidate(solver, options.kernel, coarse, progress));
    solver.refine(kFinalSteps, options.goal, 1e-4);
    if (solver.objective() >= objective) {
      solver.set_lobes(before);
      break;
    }
    if (solver.relative_l2() < path.back().relative_l2) path.back() = snapshot(solver);
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
