// Splits a lobe of the parametric model in two.
#pragma once

#include <optional>

#include "fit/tracked_solver.h"

namespace velour {

/// `lobes` with the lobe split whose halves gain most: a narrower and a wider one, slightly apart, with half the
/// coefficient each, fitted for a few steps to the residual of the other lobes. A new lobe is ranked by the residual of
/// all lobes, which says little once it is a ripple about all of them; halves start from their lobe instead. The
/// problem must hold the residuals of `lobes`. Nothing if there is no lobe.
std::optional<TrackedLobes> with_split_lobe(const TrackedProblem& problem, const TrackedLobes& lobes);

}  // namespace velour
