// Greedy choice of functions that many points share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/companded_views.h"

namespace velour {

struct PursuitChoice {
  std::vector<size_t> order;  // candidates, the most useful first
  std::vector<double> left;   // sum of squares that is left after each of them
  double all = 0;             // before the first
};

/// Simultaneous orthogonal matching pursuit [TGS06], step by step: in each the candidate whose projections explain the
/// most of all points' rests together, where every point has coefficients of its own.
class Pursuit {
 public:
  /// `columns`: of each point, pair x candidate; they must outlive this, and several pursuits may share them. `values`:
  /// of each point, by pair.
  Pursuit(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, int threads);

  /// Chooses one more; false where nothing is left to explain.
  bool step(const Progress& progress);
  const PursuitChoice& choice() const { return choice_; }

 private:
  void extend(size_t point, Eigen::Index candidate);
  double energy() const;

  const std::vector<RowMatrix>& columns_;
  std::vector<Eigen::VectorXf> rest_, norm_sq_;  // of points: of their values; of their candidates
  std::vector<Eigen::MatrixXf> basis_;           // of points: orthonormal, of the columns chosen, and room for more
  Eigen::VectorXf open_;                         // 0 for those that were chosen
  int threads_;
  PursuitChoice choice_;
};

/// `count` of them, or fewer where nothing is left to explain.
PursuitChoice pursue(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, size_t count,
                     int threads, const Progress& progress);

}  // namespace velour
