// What is broad of a slice of f cos: a clipped cosine and few Gaussians of fixed centres, by least squares.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "realtime/light_gaussians.h"

namespace velour {

/// Immutable: the least squares of any slice are a product with one matrix.
class BroadPart {
 public:
  BroadPart();
  static constexpr int kGaussians = 37, kLobes = kGaussians + 1;

  struct Fitted {
    Vec3d cosine;  // of the clipped cosine over pi
    std::vector<LightGaussian> gaussians;
  };
  /// `slice` of a direction of the sphere; below the horizon it should be 0, for light comes from there as well.
  Fitted fitted(const std::function<Vec3d(const Vec3d&)>& slice) const;

 private:
  std::vector<Vec3d> points_;
  std::vector<LightGaussian> gaussians_;
  Eigen::MatrixXd solve_;  // [lobe][point]
};

}  // namespace velour
