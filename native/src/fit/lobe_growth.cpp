#include "fit/lobe_growth.h"

#include <algorithm>

#include "fit/lobe_search.h"
#include "fit/lobe_sets.h"
#include "fit/lobe_split.h"

namespace velour {
namespace {

using Index = Eigen::Index;

// All trials take the first steps, the best one the rest.
constexpr int kFirstSteps = 3, kSteps = 20;
constexpr double kLeast = 3e-3;

}  // namespace

bool add_lobe(TrackedProblem& problem, TrackedLobes& lobes, std::span<const LobeSpace> spaces) {
  problem.evaluate(lobes.model, lobes.x);  // its residuals are what the search looks at
  std::vector<TrackedLobes> trials;
  for (const LobeSpace space : spaces) {
    if (auto trial = with_best_lobe(problem, lobes, space)) trials.push_back(std::move(*trial));
  }
  if (problem.dense()) {
    if (auto trial = with_split_lobe(problem, lobes)) trials.push_back(std::move(*trial));
  }
  for (TrackedLobes& trial : trials) refine(problem, trial, kFirstSteps, kLeast);
  const auto best =
      std::min_element(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  if (best != trials.end()) refine(problem, *best, kSteps - kFirstSteps, kLeast);
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
  refine(problem, fewer, kSteps, kLeast);
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  const bool better = add_lobe(problem, fewer, kBoth) && fewer.cost < lobes.cost;
  if (better) lobes = std::move(fewer);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

}  // namespace velour
