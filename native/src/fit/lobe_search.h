// Where one more lobe of the parametric model gains most.
#pragma once

#include <optional>

#include "fit/tracked_solver.h"

namespace velour {

/// `lobes` with one more of `space`. A list of shapes, fixed or following the view or its mirror image, is judged by
/// what each gains over all views with its best coefficient at each; the few best are fitted, each by itself, to what
/// `lobes` leave, and the best of these joins. The problem must hold the residuals of `lobes`. Nothing when no lobe
/// gains anything.
std::optional<TrackedLobes> with_best_lobe(const TrackedProblem& problem, const TrackedLobes& lobes, LobeSpace space);

}  // namespace velour
