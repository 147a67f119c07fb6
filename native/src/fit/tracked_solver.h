// Levenberg-Marquardt for the parametric model.
#pragma once

#include "fit/tracked_normal.h"

namespace velour {

/// Lobes during a fit: a ParametricBrdf with its control values in double.
struct TrackedLobes {
  ParametricBrdf model;  // spaces and order; its `control` is empty
  Eigen::VectorXd x;
  double cost = 0;
};

/// Which unknowns move.
enum class Free { all, colors };

/// Takes at most `most` steps, until one lowers the cost by less than `least` of it. Never worse than the start.
/// Deterministic for any thread count.
void refine(TrackedProblem& problem, TrackedLobes& lobes, int most, double least, Free free = Free::all);

/// Bounds of the control values of a lobe, all of them half floats. They also bound its parameters at any view.
double lower_bound(int parameter);
double upper_bound(int parameter);

}  // namespace velour
