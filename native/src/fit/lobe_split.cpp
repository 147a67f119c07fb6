#include "fit/lobe_split.h"

#include <algorithm>
#include <cmath>

#include "fit/lobe_sets.h"

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

// The halves' log bandwidth from that of their lobe, and their distance from its centre in widths.
constexpr double kNarrower = 0.5, kApart = 0.3;
constexpr int kSteps = 4;
constexpr double kLeast = 1e-3;

/// The half of `lobe`, one alone, to either `side` (1 or -1) of it.
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

}  // namespace

std::optional<TrackedLobes> with_split_lobe(const TrackedProblem& problem, const TrackedLobes& lobes) {
  std::optional<TrackedLobes> best;
  Index split = 0;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    const TrackedLobes one = only_lobe(lobes, j);
    TrackedProblem left = problem.remainder_with(one.model, one.x);
    TrackedLobes halves = joined(half_of(one, 1), half_of(one, -1));
    refine(left, halves, kSteps, kLeast);
    if (!best || halves.cost < best->cost) best = std::move(halves), split = j;
  }
  if (!best) return std::nullopt;
  return joined(without_lobe(lobes, split), *best);
}

}  // namespace velour
