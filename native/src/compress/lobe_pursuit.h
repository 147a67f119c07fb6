// Greedy choice of functions that many points share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/companded_views.h"

namespace velour {

/// A point's values and those of every candidate, both by pair.
struct PursuitPoint {
  RowMatrix column;  // pair x candidate
  Eigen::VectorXf value;
};

struct PursuitChoice {
  std::vector<size_t> order;  // candidates, the most useful first
  std::vector<double> left;   // sum of squares that is left after each of them
  double all = 0;             // before the first
};

/// Simultaneous orthogonal matching pursuit [TGS06]: in each step the candidate whose projections explain the most of
/// all points' rests together, where every point has coefficients of its own. Stops early when nothing is left to
/// explain. Changes the points' values into rests.
PursuitChoice pursue(std::vector<PursuitPoint>& points, size_t count, int threads, const Progress& progress);

}  // namespace velour
