#include "fit/lobe_growth.h"

#include "fit/lobe_search.h"

namespace velour {
namespace {

using Index = Eigen::Index;

constexpr int kSteps = 20;
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
  const TrackedLobes before = lobes;
  for (const LobeSpace space : spaces) {
    problem.evaluate(before.model, before.x);  // its residuals are what the search looks at
    auto trial = with_best_lobe(problem, before, space);
    if (!trial) continue;
    refine(problem, *trial, kSteps, kLeast);
    if (trial->cost < lobes.cost) lobes = std::move(*trial);
  }
  problem.evaluate(lobes.model, lobes.x);
  return lobes.model.lobe_count() > before.model.lobe_count();
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
