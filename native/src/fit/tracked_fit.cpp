#include "fit/tracked_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "fit/fit_report.h"
#include "fit/lobe_search.h"

namespace velour {
namespace {

using Index = Eigen::Index;

constexpr int kGrowthSteps = 20;
constexpr double kGrowthLeast = 3e-3;
constexpr int kPolishSteps = 80, kRounds = 4, kRoundSteps = 8;
constexpr double kPolishLeast = 3e-4;

OrderPoint order_point(const TrackedProblem& problem, const TrackedLobes& lobes) {
  OrderPoint point;
  point.lobes = lobes.model.lobe_count();
  point.parameter_bytes =
      ParametricBrdf::parameter_bytes(static_cast<uint64_t>(lobes.x.size()), lobes.model.space.size());
  double weight = 0;
  for (const TrackedView& v : problem.views()) {
    point.worst = std::max(point.worst, v.error / v.goal);
    point.relative_l2 += v.wv.z * v.error;
    weight += v.wv.z;
  }
  point.relative_l2 /= std::max(weight, 1e-12);
  return point;
}

/// Views that are far from their goal count more from now on.
void reweight(TrackedProblem& problem) {
  double square = 0, mean = 0;
  const double n = static_cast<double>(problem.views().size());
  for (const TrackedView& v : problem.views()) square += (v.error / v.goal) * (v.error / v.goal) / n;
  for (TrackedView& v : problem.views()) {
    v.weight *= std::clamp(v.error / v.goal / std::sqrt(square), 0.6, 1.8);
    mean += v.weight / n;
  }
  for (TrackedView& v : problem.views()) v.weight /= mean;
}

bool is_color(const ParametricBrdf& model, Index i) {
  const int p = static_cast<int>(i / model.lobe_count()) % model.parameter_count();
  return p >= ParametricBrdf::kLogRed && p <= ParametricBrdf::kLogBlue;
}

double half(double value) { return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value))); }

/// Rounds to what the file holds: shapes first, so that the colours can make up for it.
void round_to_half(TrackedProblem& problem, TrackedLobes& lobes) {
  for (const bool colors : {false, true}) {
    for (Index i = 0; i < lobes.x.size(); ++i) {
      if (is_color(lobes.model, i) == colors) lobes.x[i] = half(lobes.x[i]);
    }
    if (!colors) refine(problem, lobes, 4, 1e-3, Free::colors);
  }
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

/// One lobe more, of the space that fits better with it. False when neither lowers the cost.
bool grow(TrackedProblem& problem, TrackedLobes& lobes) {
  const TrackedLobes before = lobes;
  for (const LobeSpace space : {LobeSpace::half, LobeSpace::light}) {
    problem.evaluate(before.model, before.x);  // its residuals are what the search looks at
    auto trial = with_best_lobe(problem, before, space);
    if (!trial) continue;
    refine(problem, *trial, kGrowthSteps, kGrowthLeast);
    if (trial->cost < lobes.cost) lobes = std::move(*trial);
  }
  problem.evaluate(lobes.model, lobes.x);
  return lobes.model.lobe_count() > before.model.lobe_count();
}

}  // namespace

TrackedFit fit_tracked(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options, Progress& progress) {
  const ViewSpline spline(options.isotropic, options.cells);
  TrackedProblem problem(
      slices, spline, [&](double theta_v) { return tolerance_at(options.tolerance, theta_v); }, options.threads,
      progress);
  TrackedFit fit;
  TrackedLobes lobes;
  lobes.model.isotropic = options.isotropic;
  lobes.model.cells = options.cells;
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
  while (lobes.model.lobe_count() < options.max_lobes && grow(problem, lobes)) {
    fit.order.points.push_back(order_point(problem, lobes));
    progress.update(static_cast<double>(lobes.model.lobe_count()) / options.max_lobes);
  }
  if (lobes.model.lobe_count() > 0) {
    refine(problem, lobes, kPolishSteps, kPolishLeast);
    for (int round = 0; round < kRounds; ++round) {
      reweight(problem);
      refine(problem, lobes, kRoundSteps, kPolishLeast);
    }
    round_to_half(problem, lobes);
    // What the growth ends with takes the place of its last point.
    fit.order.points.back() = order_point(problem, lobes);
    fit.order.chosen = fit.order.points.size() - 1;
  }
  fit.brdf = lobes.model;
  for (const double v : lobes.x) fit.brdf.control.push_back(static_cast<float>(v));
  for (const TrackedView& v : problem.views()) {
    fit.views.push_back(v.wv);
    fit.error.push_back(v.error);
  }
  return fit;
}

}  // namespace velour
