// Least-squares fit of the broad part of a slice of f cos: a clipped cosine and a few Gaussians with fixed centers, in
// addition to the slice's own Gaussians.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "realtime/light_gaussians.h"

namespace velour {

/// Immutable: the least-squares solution of any slice is a product with one matrix.
class BroadPart {
 public:
  BroadPart();
  static constexpr int kGaussians = 37, kLobes = kGaussians + 1;

  struct Fitted {
    Vec3d cosine;  // of the clipped cosine over pi
    std::vector<LightGaussian> gaussians;
  };
  /// `slice` takes any direction of the sphere; it should be 0 below the horizon, because light comes from there, too.
  /// Fits the residual of `slice` after `own`, whose colors change only where that helps much, because they are blended
  /// with those of neighboring views.
  Fitted fitted(const std::function<Vec3d(const Vec3d&)>& slice, std::span<LightGaussian> own) const;

 private:
  void mend(std::span<LightGaussian* const> own, Eigen::MatrixXd& left) const;

  std::vector<Vec3d> points_;
  std::vector<LightGaussian> gaussians_;
  Eigen::MatrixXd values_, solve_;  // [lobe][point]
};

}  // namespace velour
