#include "brdf/fit/parametric/lobe_growth.h"

#include <algorithm>
#include <cmath>
#include <vector>
#include "base/parallel.h"
#include "brdf/fit/parametric/lobe_search.h"

namespace velour {

namespace {

using Index = Eigen::Index;

// Every trial takes the first steps; only the best takes the remaining ones.
constexpr int kFirstSteps = 3, kGrowthSteps = 20;
constexpr double kGrowthTolerance = 3e-3;

/// Trials after their first steps: a new lobe in each of the `spaces` and, if samples are dense, a split lobe.
std::vector<FitLobes> first_steps(const FitProblem& problem, const FitLobes& lobes, std::span<const LobeSpace> spaces) {
  std::vector<std::optional<FitLobes>> found(spaces.size() + (problem.dense() ? 1 : 0));
  parallel_pieces(found.size(), problem.threads(), problem.progress(), [&](size_t i) {
    found[i] = i < spaces.size() ? with_best_lobe(problem, lobes, spaces[i]) : with_split_lobe(problem, lobes);
    if (!found[i]) return;
    FitProblem own = problem;
    refine(own, *found[i], kFirstSteps, kGrowthTolerance);
  });
  std::vector<FitLobes> out;
  for (std::optional<FitLobes>& trial : found) {
    if (trial) out.push_back(std::move(*trial));
  }
  return out;
}

}  // namespace

bool add_lobe(FitProblem& problem, FitLobes& lobes, std::span<const LobeSpace> spaces) {
  problem.evaluate(lobes.model, lobes.x);  // the search reads its residuals
  std::vector<FitLobes> trials = first_steps(problem, lobes, spaces);
  const auto best = std::min_element(trials.begin(), trials.end(), costs_less);
  if (best != trials.end()) refine(problem, *best, kGrowthSteps - kFirstSteps, kGrowthTolerance);
  const bool better = best != trials.end() && best->cost < lobes.cost;
  if (better) lobes = std::move(*best);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

bool exchange_lobe(FitProblem& problem, FitLobes& lobes) {
  if (lobes.model.lobe_count() < 2) return false;
  FitLobes fewer;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    FitLobes trial = without_lobe(lobes, j);
    trial.cost = problem.evaluate(trial.model, trial.x);
    if (j == 0 || trial.cost < fewer.cost) fewer = std::move(trial);
  }
  refine(problem, fewer, kGrowthSteps, kGrowthTolerance);
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  const bool better = add_lobe(problem, fewer, kBoth) && fewer.cost < lobes.cost;
  if (better) lobes = std::move(fewer);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

namespace {

using Index = Eigen::Index;

/// Number of rows of the control values [node][parameter][lobe], each of all lobes.
Index rows_of(const ParametricBrdf& model) {
  return static_cast<Index>(model.spline().node_count()) * model.parameter_count();
}

}  // namespace

FitLobes without_lobe(const FitLobes& lobes, Index lobe) {
  FitLobes out = lobes;
  out.model.space.erase(out.model.space.begin() + lobe);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows * (count - 1));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (count - 1), lobe) = lobes.x.segment(r * count, lobe);
    out.x.segment(r * (count - 1) + lobe, count - 1 - lobe) = lobes.x.segment(r * count + lobe + 1, count - 1 - lobe);
  }
  return out;
}

FitLobes only_lobe(const FitLobes& lobes, Index lobe) {
  FitLobes out = lobes;
  out.model.space.assign(1, lobes.model.space[static_cast<size_t>(lobe)]);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows);
  for (Index r = 0; r < rows; ++r) out.x[r] = lobes.x[r * count + lobe];
  return out;
}

FitLobes joined(const FitLobes& lobes, const FitLobes& more) {
  FitLobes out = lobes;
  out.model.space.insert(out.model.space.end(), more.model.space.begin(), more.model.space.end());
  const Index rows = rows_of(lobes.model), first = lobes.model.lobe_count(), second = more.model.lobe_count();
  out.x.resize(rows * (first + second));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (first + second), first) = lobes.x.segment(r * first, first);
    out.x.segment(r * (first + second) + first, second) = more.x.segment(r * second, second);
  }
  return out;
}

namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

// Offsets of the halves from their lobe: of the log bandwidth, and of the center in lobe widths.
constexpr double kNarrower = 0.5, kApart = 0.3;
// The halves of all lobes are refined by one step, those of the kKept best by more.
constexpr size_t kKept = 3;
constexpr int kSplitSteps = 3;
constexpr double kSplitTolerance = 1e-3;

/// The half on `side` (1 or -1) of `lobe`, which has a single lobe.
FitLobes half_of(const FitLobes& lobe, double side) {
  FitLobes half = lobe;
  const Index parameters = lobe.model.parameter_count();
  for (Index node = 0; node < lobe.x.size(); node += parameters) {
    const double width = std::exp(-0.5 * std::max(lobe.x[node + P::kLogBandwidth], 0.0));
    half.x[node + P::kLogBandwidth] += side * kNarrower;
    half.x[node + P::kTiltX] += side * kApart * width;
    for (const int color : {P::kLogRed, P::kLogGreen, P::kLogBlue}) half.x[node + color] -= std::log(2.0);
    for (int p = 0; p < parameters; ++p) {
      half.x[node + p] = std::clamp(half.x[node + p], lower_bound(p), upper_bound(p));
    }
  }
  return half;
}

/// The halves of a lobe, fitted to the residual of the others.
struct Split {
  Index lobe;
  FitLobes halves;

  void refine_beside(const FitProblem& problem, const FitLobes& one, int steps) {
    FitProblem left = problem.remainder_with(one.model, one.x);
    refine(left, halves, steps, kSplitTolerance);
  }
};

}  // namespace

std::optional<FitLobes> with_split_lobe(const FitProblem& problem, const FitLobes& lobes) {
  const auto cheaper = [](const Split& a, const Split& b) { return costs_less(a.halves, b.halves); };
  std::vector<Split> splits;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    const FitLobes one = only_lobe(lobes, j);
    splits.push_back({j, joined(half_of(one, 1), half_of(one, -1))});
  }
  const auto refine_all = [&](int steps) {
    parallel_pieces(splits.size(), problem.threads(), problem.progress(),
                    [&](size_t s) { splits[s].refine_beside(problem, only_lobe(lobes, splits[s].lobe), steps); });
  };
  refine_all(1);
  std::stable_sort(splits.begin(), splits.end(), cheaper);
  splits.resize(std::min(splits.size(), kKept), {0, lobes});
  refine_all(kSplitSteps);
  const auto best = std::min_element(splits.begin(), splits.end(), cheaper);
  if (best == splits.end()) return std::nullopt;
  return joined(without_lobe(lobes, best->lobe), best->halves);
}

}  // namespace velour
