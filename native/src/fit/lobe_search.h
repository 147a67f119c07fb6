// Where one more lobe of the parametric model gains most.
#pragma once

#include <optional>

#include "fit/tracked_solver.h"

namespace velour {

/// `lobes` with one more: that of `space` which lowers the errors of `problem` most by itself, all views together, of a
/// list of shapes, fixed or following the view or its mirror image, with the best coefficient at each view. The problem
/// must hold the residuals of `lobes`. Nothing when no lobe gains anything.
std::optional<TrackedLobes> with_best_lobe(const TrackedProblem& problem, const TrackedLobes& lobes, LobeSpace space);

}  // namespace velour
