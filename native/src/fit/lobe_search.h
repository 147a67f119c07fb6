// Where one more lobe of the parametric model gains most.
#pragma once

#include "fit/tracked_solver.h"

namespace velour {

/// Adds to `lobes` the lobe that lowers the errors of `problem` most, all views together, by itself: from a list of
/// shapes in both spaces, fixed or following the view or its mirror image, with the best coefficient at each view. The
/// problem must hold the residuals of `lobes`. False, and nothing added, when no lobe gains anything.
bool add_best_lobe(const TrackedProblem& problem, TrackedLobes& lobes);

}  // namespace velour
