// Finds the best additional lobe of the parametric model.
#pragma once

#include <optional>

#include "brdf/fit/parametric/solver.h"

namespace velour {

/// `lobes` with one more lobe in `space`. A list of shapes, fixed or following the view or its mirror direction, is
/// ranked by the gain of each over all views with its best coefficient at each. The few best are fitted separately to
/// the residual of `lobes`, and the best of these is added. The problem must hold the residuals of `lobes`. Nothing if
/// no shape gains anything.
std::optional<FitLobes> with_best_lobe(const FitProblem& problem, const FitLobes& lobes, LobeSpace space);

}  // namespace velour
