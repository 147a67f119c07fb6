// Descents of a fit of closures, and where they start.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closure_problem.h"

namespace velour {

// Where descents of a fit of closures start.

/// Lobes and their unknowns.
struct ClosureSolution {
  std::vector<LobeDistribution> distributions;
  ClosureUnknowns unknowns = ClosureUnknowns::Zero(kClosureKnots, 3);
  double cost = 0;  // of ClosureProblem
};

/// `from` with one more lobe, for each kind of lobe; the most promising first. Alphas and tilts of the added lobe are
/// scanned and judged with the best weights of all lobes at each view. The start gives the lobe a part of the albedo.
std::vector<ClosureSolution> closure_starts(const std::vector<ClosureView>& views, const ClosureSolution& from,
                                            LobeMasking masking, const ClosureBounds& bounds);

struct ClosureSearchOptions {
  LobeMasking masking = LobeMasking::separable;
  ClosureBounds bounds{};
  int threads = 0;
};

/// The best network found with one more lobe than `from`: starts of each kind descend a few steps, the best of them to
/// the end. Then each lobe is tried with the other distribution.
ClosureSolution one_more_lobe(const std::vector<ClosureView>& views, const ClosureSolution& from,
                              const ClosureSearchOptions& options, const Progress& progress);

}  // namespace velour
