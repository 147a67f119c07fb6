// Descents of a fit of closures.
#pragma once

#include "base/progress.h"
#include "brdf/fit/closures/closure_starts.h"

namespace velour {

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
