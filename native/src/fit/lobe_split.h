// One lobe of the parametric model becomes two.
#pragma once

#include <optional>

#include "fit/tracked_solver.h"

namespace velour {

/// `lobes` with that one split whose halves gain most: a narrower and a wider one, a little apart, of half the
/// coefficient each, fitted for a few steps to what the other lobes leave. A new lobe is judged by what is left over,
/// which tells little once that is a ripple about all lobes; halves begin where their lobe was. The problem must hold
/// the residuals of `lobes`. Nothing when there is no lobe.
std::optional<TrackedLobes> with_split_lobe(const TrackedProblem& problem, const TrackedLobes& lobes);

}  // namespace velour
