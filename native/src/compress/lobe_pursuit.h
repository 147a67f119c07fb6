// Greedy choice of functions shared by many points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/companded_views.h"

namespace velour {

struct PursuitChoice {
  std::vector<size_t> order;  // candidates, most useful first
  std::vector<double> left;   // residual sum of squares after each of them
  double all = 0;             // before the first
};

/// Simultaneous orthogonal matching pursuit [TGS06]. Each step chooses the candidate whose projections explain the most
/// of all points' residuals together; every point has its own coefficients.
class Pursuit {
 public:
  /// `columns`: per point, pair x candidate; must outlive this object and may be shared by several. `values`: per
  /// point, by pair.
  Pursuit(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, int threads);

  /// Chooses another candidate; false if nothing is left to explain.
  bool step(const Progress& progress);
  const PursuitChoice& choice() const { return choice_; }

 private:
  void extend(size_t point, Eigen::Index candidate);
  double energy() const;

  const std::vector<RowMatrix>& columns_;
  std::vector<Eigen::VectorXf> rest_, norm_sq_;  // per point: residual of the values; squared norms of the candidates
  std::vector<Eigen::MatrixXf> basis_;           // per point: orthonormal basis of the chosen columns, and room
  Eigen::VectorXf open_;                         // 0 for chosen candidates, else 1
  int threads_;
  PursuitChoice choice_;
};

/// Chooses `count` candidates, or fewer if nothing is left to explain.
PursuitChoice pursue(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, size_t count,
                     int threads, const Progress& progress);

}  // namespace velour
