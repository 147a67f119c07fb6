// What is broad of a slice of f cos: a clipped cosine and few Gaussians of fixed centres, with those that the slice has
// of its own, by least squares.
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
  /// `slice` of a direction of the sphere; below the horizon it should be 0, for light comes from there as well. The
  /// fit is what is left of it by `own`, whose colours change where that helps much: views beside this one blend
  /// theirs.
  Fitted fitted(const std::function<Vec3d(const Vec3d&)>& slice, std::span<LightGaussian> own) const;

 private:
  void mend(std::span<LightGaussian* const> own, Eigen::MatrixXd& left) const;

  std::vector<Vec3d> points_;
  std::vector<LightGaussian> gaussians_;
  Eigen::MatrixXd values_, solve_;  // [lobe][point]
};

}  // namespace velour
