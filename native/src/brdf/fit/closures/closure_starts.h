// Where descents of a fit of closures start.
#pragma once

#include <vector>
#include "brdf/fit/closures/closure_problem.h"

namespace velour {

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

}  // namespace velour
