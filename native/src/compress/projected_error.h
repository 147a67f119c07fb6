// Residual of shared lobes at the points by which they are refined.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>

#include "compress/surface_points.h"

namespace velour {

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

}  // namespace velour
