// Choice of the shared lobes: the order in which they are worth their bytes, and their refinement by descent.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/side_views.h"
#include "math/srbf/multivariate_lobes.h"

namespace velour {

// Refinement of shared lobes by descent.

struct RefinementOptions {
  uint32_t tile_lobes = 0;  // number of lobes in the tile's frame
  int steps = 0;
  int threads = 0;
};

/// Minimizes the error of color axis 0 over all vectors of all lobes, where every point has its best coefficients
/// (variable projection [GP73]). Zero vectors start as short ones; from there the error never rises. The same bits for
/// any number of threads.
std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress);

// Residual of shared lobes at the points by which they are refined.

class LobeValues;

/// The squared error of color axis 0 over all points, each with its best coefficients, as a function of the lobes'
/// vectors alone (variable projection [GP73]). A slight ridge on the coefficients counts as error.
class ProjectedError {
 public:
  /// The first `tile_lobes` lobes are in the tile's frame. The points must outlive this object.
  ProjectedError(const std::vector<SurfacePoint>& points, uint32_t tile_lobes, int threads, const Progress& progress);

  /// Returns the error and writes its slope by the lobes' numbers, a column of MultivariateLobe::kNumbers per lobe. A
  /// zero vector gets the slope of its argument alone, not of its length. The same bits for any number of threads.
  double operator()(const std::vector<MultivariateLobe>& lobes, Eigen::MatrixXd& slope) const;

 private:
  struct Part;
  Part of_point(size_t number, const std::vector<MultivariateLobe>& lobes, const LobeValues& values) const;

  const std::vector<SurfacePoint>& points_;
  uint32_t tile_lobes_;
  int threads_;
  const Progress& progress_;
  std::vector<std::array<Eigen::Matrix<float, MultivariateLobe::kNumbers, Eigen::Dynamic>, 2>>
      argument_;  // per point, in both frames
};

// Values of shared lobes at the pairs of a point.

/// Lobes of both frames. Columns of values: those in the tile's frame, then those in the normal's, without padding.
class LobeValues {
 public:
  LobeValues(std::span<const MultivariateLobe> lobes, uint32_t tile_lobes)
      : tile_(lobes.first(tile_lobes)), texel_(lobes.subspan(tile_lobes)) {}

  /// Values pair x lobe, for at most `pairs` pairs of the point.
  RowMatrix at(const SurfacePoint& point, size_t pairs) const;

 private:
  MultivariateLobes tile_, texel_;
};

// The order in which lobes are worth their bytes.

// Greedy choice of functions shared by many points.

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

/// Lobes to choose from: random lobes of light, view, half vector and their products, those in the tile's frame first.
/// The first one is the constant.
struct LobeCandidates {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
};
inline constexpr uint32_t kLobeCandidates = 2048;
inline constexpr uint64_t kOrderPairs = 400;  // per point, for choosing an order
LobeCandidates random_candidates(uint64_t seed);

/// Values of all candidates at the first points, pair x candidate each; and values of the points along an axis.
std::vector<RowMatrix> candidate_columns(const std::vector<SurfacePoint>& points, const LobeCandidates& candidates,
                                         size_t most_points, size_t most_pairs, int threads, const Progress& progress);
std::vector<Eigen::VectorXf> point_values(const std::vector<SurfacePoint>& points,
                                          const std::vector<RowMatrix>& columns, size_t axis);

/// The order of a texel's coefficients: each goes to the color axis whose next candidate explains the most.
struct LobeOrder {
  std::array<std::vector<size_t>, 3> candidate;  // per axis, most useful first; axis 0 has at least one
  std::vector<uint8_t> axis;                     // per coefficient
  std::vector<double> left;                      // residual after each coefficient, as a share of all squares

  /// Number of the first `count` coefficients that go to each axis.
  std::array<size_t, 3> share(size_t count) const;
};

struct LobeOrderOptions {
  size_t most = 0;       // maximum number of coefficients
  double least = 0;      // stops when the residual share of squares is no more than this
  uint32_t points = 64;  // used for the choice
  uint64_t seed = 0;
  int threads = 0;
};

/// Greedy choice among random candidates. If there is nothing to explain (black), takes the constant.
LobeOrder order_lobes(const std::vector<SurfacePoint>& points, const LobeOrderOptions& options, Progress& progress);

}  // namespace velour
