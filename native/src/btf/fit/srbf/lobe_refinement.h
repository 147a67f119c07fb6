// Refinement of shared lobes by descent.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>
#include "btf/fit/companded_views.h"
#include "btf/fit/surface_points.h"
#include "math/srbf/multivariate_lobes.h"

namespace velour {

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

}  // namespace velour
