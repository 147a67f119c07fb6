// What shared lobes leave of the points that they are refined by.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>

#include "compress/surface_points.h"

namespace velour {

class LobeValues;

/// The squared error of colour axis 0 over all points, each with its best coefficients, as a function of the lobes'
/// vectors alone (variable projection [GP73]). A slight ridge on the coefficients counts as error.
class ProjectedError {
 public:
  /// Of lobes whose first `tile_lobes` are in the tile's frame. The points must outlive this.
  ProjectedError(const std::vector<SurfacePoint>& points, uint32_t tile_lobes, int threads, const Progress& progress);

  /// Writes the slope by the components of light, view and half vector, a column of nine a lobe. A vector of no length
  /// has the slope of its argument alone. The same bits for any number of threads.
  double operator()(const std::vector<MultivariateLobe>& lobes, Eigen::MatrixXd& slope) const;

 private:
  struct Part;
  Part of_point(size_t number, const std::vector<MultivariateLobe>& lobes, const LobeValues& values) const;

  const std::vector<SurfacePoint>& points_;
  uint32_t tile_lobes_;
  int threads_;
  const Progress& progress_;
  std::vector<std::array<Eigen::Matrix<float, MultivariateLobe::kNumbers, Eigen::Dynamic>, 2>>
      argument_;  // of each point, in both frames
};

}  // namespace velour
