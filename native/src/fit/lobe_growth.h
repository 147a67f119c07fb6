// How the lobes of the parametric model come and go.
#pragma once

#include <span>

#include "fit/tracked_solver.h"

namespace velour {

/// One lobe more: a new one of one of the `spaces`, or, where samples are dense, one split in two; what fits best.
/// False, and nothing changed, when nothing lowers the cost.
bool add_lobe(TrackedProblem& problem, TrackedLobes& lobes, std::span<const LobeSpace> spaces);

/// Takes out the lobe that is missed least and adds the one that gains most without it. False, and nothing changed,
/// when that does not lower the cost or there is but one.
bool exchange_lobe(TrackedProblem& problem, TrackedLobes& lobes);

}  // namespace velour
