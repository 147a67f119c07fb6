// Adds and exchanges lobes of the parametric model.
#pragma once

#include <span>

#include "fit/tracked_solver.h"

namespace velour {

/// Adds the best lobe: a new one in one of the `spaces` or, if samples are dense, by splitting one in two. Returns
/// false and changes nothing if that does not lower the cost.
bool add_lobe(TrackedProblem& problem, TrackedLobes& lobes, std::span<const LobeSpace> spaces);

/// Removes the least important lobe and adds the one that gains most without it. Returns false and changes nothing if
/// that does not lower the cost or there are fewer than two lobes.
bool exchange_lobe(TrackedProblem& problem, TrackedLobes& lobes);

}  // namespace velour
