#include "brdf/fit/closures/closure_search.h"

#include <algorithm>
#include "base/parallel.h"
#include "math/optimize/levenberg_marquardt.h"

namespace velour {

namespace {

constexpr DescentOptions kTrial{.steps = 8, .settled = 1e-3, .damping = 1e-2, .by_gain = true};
constexpr DescentOptions kFull{.steps = 25, .settled = 1e-3, .damping = 1e-2, .by_gain = true};

/// `s` with the other distribution for lobe `k`, and an alpha for about the same width.
ClosureSolution flipped(ClosureSolution s, size_t k, const ClosureBounds& bounds) {
  constexpr double kBeckmannAlpha = 1.4;  // of a lobe as wide as GGX
  LobeDistribution& distribution = s.distributions[k];
  const bool was_ggx = distribution == LobeDistribution::ggx;
  distribution = was_ggx ? LobeDistribution::beckmann : LobeDistribution::ggx;
  auto unknowns = s.unknowns.col(lobe_unknown(static_cast<int>(k)) + 3);
  for (int i = 0; i < kClosureKnots; ++i) {
    const double alpha = closure_shape(unknowns[i], 0, 0, 0, bounds).alpha;
    unknowns[i] =
        closure_alpha_unknown(std::min(was_ggx ? kBeckmannAlpha * alpha : alpha / kBeckmannAlpha, 1.0), bounds);
  }
  return s;
}

/// The results of descents from `starts`, at least one.
class ClosureSearch {
 public:
  ClosureSearch(const std::vector<ClosureView>& views, const ClosureSearchOptions& options, const Progress& progress)
      : views_(views), options_(options), progress_(progress) {}

  ClosureSolution descended(ClosureSolution s, const DescentOptions& descent) const {
    const ClosureProblem problem(views_, s.distributions, options_.masking, options_.bounds);
    s.unknowns = descend(
        problem, s.unknowns, [&] { progress_.check(); }, descent);
    s.cost = problem.cost(s.unknowns);
    return s;
  }

  ClosureSolution best_of(std::vector<ClosureSolution> starts, const DescentOptions& descent) const {
    parallel_pieces(starts.size(), options_.threads, progress_,
                    [&](size_t i) { starts[i] = descended(starts[i], descent); });
    return *std::min_element(starts.begin(), starts.end(),
                             [](const ClosureSolution& a, const ClosureSolution& b) { return a.cost < b.cost; });
  }

 private:
  const std::vector<ClosureView>& views_;
  const ClosureSearchOptions& options_;
  const Progress& progress_;
};

}  // namespace

ClosureSolution one_more_lobe(const std::vector<ClosureView>& views, const ClosureSolution& from,
                              const ClosureSearchOptions& options, const Progress& progress) {
  const ClosureSearch search(views, options, progress);
  // Short trials choose starts that end in poor minima.
  const ClosureSolution best = search.best_of(closure_starts(views, from, options.masking, options.bounds), kFull);
  std::vector<ClosureSolution> flips;
  for (size_t k = 0; k < best.distributions.size(); ++k) flips.push_back(flipped(best, k, options.bounds));
  const ClosureSolution flip = search.best_of(std::move(flips), kTrial);
  return flip.cost < best.cost ? search.descended(flip, kFull) : best;
}

}  // namespace velour
