#include "fit/lobe_growth.h"

#include <algorithm>

#include "fit/lobe_search.h"
#include "fit/lobe_sets.h"
#include "fit/lobe_split.h"
#include "job/parallel.h"

namespace velour {
namespace {

using Index = Eigen::Index;

// Every trial takes the first steps; only the best takes the remaining ones.
constexpr int kFirstSteps = 3, kGrowthSteps = 20;
constexpr double kGrowthTolerance = 3e-3;

/// Trials after their first steps: a new lobe in each of the `spaces` and, if samples are dense, a split lobe.
std::vector<TrackedLobes> first_steps(const TrackedProblem& problem, const TrackedLobes& lobes,
                                      std::span<const LobeSpace> spaces) {
  std::vector<std::optional<TrackedLobes>> found(spaces.size() + (problem.dense() ? 1 : 0));
  parallel_pieces(found.size(), problem.threads(), problem.progress(), [&](size_t i) {
    found[i] = i < spaces.size() ? with_best_lobe(problem, lobes, spaces[i]) : with_split_lobe(problem, lobes);
    if (!found[i]) return;
    TrackedProblem own = problem;
    refine(own, *found[i], kFirstSteps, kGrowthTolerance);
  });
  std::vector<TrackedLobes> out;
  for (std::optional<TrackedLobes>& trial : found) {
    if (trial) out.push_back(std::move(*trial));
  }
  return out;
}

}  // namespace

bool add_lobe(TrackedProblem& problem, TrackedLobes& lobes, std::span<const LobeSpace> spaces) {
  problem.evaluate(lobes.model, lobes.x);  // the search reads its residuals
  std::vector<TrackedLobes> trials = first_steps(problem, lobes, spaces);
  const auto best = std::min_element(trials.begin(), trials.end(), costs_less);
  if (best != trials.end()) refine(problem, *best, kGrowthSteps - kFirstSteps, kGrowthTolerance);
  const bool better = best != trials.end() && best->cost < lobes.cost;
  if (better) lobes = std::move(*best);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

bool exchange_lobe(TrackedProblem& problem, TrackedLobes& lobes) {
  if (lobes.model.lobe_count() < 2) return false;
  TrackedLobes fewer;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    TrackedLobes trial = without_lobe(lobes, j);
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

}  // namespace velour
