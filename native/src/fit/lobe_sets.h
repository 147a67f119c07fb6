// Removes, extracts and joins lobes of a parametric fit.
#pragma once

#include "fit/tracked_solver.h"

namespace velour {

inline bool costs_less(const TrackedLobes& a, const TrackedLobes& b) { return a.cost < b.cost; }

TrackedLobes without_lobe(const TrackedLobes& lobes, Eigen::Index lobe);

TrackedLobes only_lobe(const TrackedLobes& lobes, Eigen::Index lobe);

/// The lobes of both, those of `more` last. The models may differ only in their lobes.
TrackedLobes joined(const TrackedLobes& lobes, const TrackedLobes& more);

}  // namespace velour
