// Lobes taken out of, and put into, those of a parametric fit.
#pragma once

#include "fit/tracked_solver.h"

namespace velour {

inline bool costs_less(const TrackedLobes& a, const TrackedLobes& b) { return a.cost < b.cost; }

TrackedLobes without_lobe(const TrackedLobes& lobes, Eigen::Index lobe);

/// One of them, alone.
TrackedLobes only_lobe(const TrackedLobes& lobes, Eigen::Index lobe);

/// Both, those of `more` last. Their models differ in nothing but lobes.
TrackedLobes joined(const TrackedLobes& lobes, const TrackedLobes& more);

}  // namespace velour
