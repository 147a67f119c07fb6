// Adds and exchanges lobes of the parametric model.
#pragma once

#include <optional>
#include <span>
#include "brdf/fit/parametric/solver.h"

namespace velour {

/// Views in which the place of a lobe is sought: every second one if samples are dense, or all.
enum class Search { quick, thorough };

/// Adds the best lobe: a new one in one of the `spaces` or, if samples are dense, by splitting one in two. Returns
/// false and changes nothing if that does not lower the cost.
bool add_lobe(FitProblem& problem, FitLobes& lobes, std::span<const LobeSpace> spaces, Search search = Search::quick);

/// Removes the least important lobe and adds the one that gains most without it. Returns false and changes nothing if
/// that does not lower the cost or there are fewer than two lobes.
bool exchange_lobe(FitProblem& problem, FitLobes& lobes);

// Removes, extracts and joins lobes of a parametric fit.

inline bool costs_less(const FitLobes& a, const FitLobes& b) { return a.cost < b.cost; }

FitLobes without_lobe(const FitLobes& lobes, Eigen::Index lobe);

FitLobes only_lobe(const FitLobes& lobes, Eigen::Index lobe);

/// The lobes of both, those of `more` last. The models may differ only in their lobes.
FitLobes joined(const FitLobes& lobes, const FitLobes& more);

// Splits a lobe of the parametric model in two.

/// `lobes` with the lobe split whose halves gain most: a narrower and a wider one, slightly apart, with half the
/// coefficient each, fitted for a few steps to the residual of the other lobes. A new lobe is ranked by the residual of
/// all lobes, which says little once it is a ripple about all of them; halves start from their lobe instead. The
/// problem must hold the residuals of `lobes`. Nothing if there is no lobe.
std::optional<FitLobes> with_split_lobe(const FitProblem& problem, const FitLobes& lobes);

}  // namespace velour
