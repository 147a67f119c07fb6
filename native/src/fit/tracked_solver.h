// Levenberg-Marquardt for the parametric model.
#pragma once

#include "fit/tracked_normal.h"

namespace velour {

/// Lobes while they are fitted: what a ParametricBrdf holds, its control values in double.
struct TrackedLobes {
  ParametricBrdf model;  // spaces and order; its `control` is empty
  Eigen::VectorXd x;
  double cost = 0;
};

/// Which unknowns move.
enum class Free { all, colors };

/// Steps until one lowers the cost by less than `least` of it, or `most` of them. Never worse than the start.
/// Deterministic for any thread count.
void refine(TrackedProblem& problem, TrackedLobes& lobes, int most, double least, Free free = Free::all);

/// What a lobe may be at any view: bounds of its control values, all of them half floats.
double lower_bound(int parameter);
double upper_bound(int parameter);

}  // namespace velour
