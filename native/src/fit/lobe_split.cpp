#include "fit/lobe_split.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/lobe_sets.h"
#include "job/parallel.h"

namespace velour {
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
TrackedLobes half_of(const TrackedLobes& lobe, double side) {
  TrackedLobes half = lobe;
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
  TrackedLobes halves;

  void refine_beside(const TrackedProblem& problem, const TrackedLobes& one, int steps) {
    TrackedProblem left = problem.remainder_with(one.model, one.x);
    refine(left, halves, steps, kSplitTolerance);
  }
};

}  // namespace

std::optional<TrackedLobes> with_split_lobe(const TrackedProblem& problem, const TrackedLobes& lobes) {
  const auto cheaper = [](const Split& a, const Split& b) { return costs_less(a.halves, b.halves); };
  std::vector<Split> splits;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    const TrackedLobes one = only_lobe(lobes, j);
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
