#include "fit/lobe_growth.h"

#include <algorithm>

#include "fit/lobe_search.h"

namespace velour {
namespace {

using Index = Eigen::Index;

// Both spaces take the first steps, the better one the rest.
constexpr int kFirstSteps = 3, kSteps = 20;
constexpr double kLeast = 3e-3;

TrackedLobes without_lobe(const TrackedLobes& lobes, Index lobe) {
  TrackedLobes out = lobes;
  out.model.space.erase(out.model.space.begin() + lobe);
  const Index old = lobes.model.lobe_count(), columns = lobes.x.size() / old;  // node x parameter
  out.x.resize(columns * (old - 1));
  for (Index c = 0; c < columns; ++c) {
    out.x.segment(c * (old - 1), lobe) = lobes.x.segment(c * old, lobe);
    out.x.segment(c * (old - 1) + lobe, old - 1 - lobe) = lobes.x.segment(c * old + lobe + 1, old - 1 - lobe);
  }
  return out;
}

}  // namespace

bool add_lobe(TrackedProblem& problem, TrackedLobes& lobes, std::span<const LobeSpace> spaces) {
  problem.evaluate(lobes.model, lobes.x);  // its residuals are what the search looks at
  std::vector<TrackedLobes> trials;
  for (const LobeSpace space : spaces) {
    if (auto trial = with_best_lobe(problem, lobes, space)) trials.push_back(std::move(*trial));
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
