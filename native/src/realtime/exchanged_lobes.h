// The half of a symmetric model with light and view exchanged, as lobes over light directions.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>
#include "brdf/model/parametric_brdf.h"
#include "realtime/light_gaussians.h"

namespace velour {

/// Half of f is g(wl) = 1/2 sum_j beta_j(wl) exp(lambda_j(wl) (psi_j . xi_j(wl) - 1)), psi_j with wl and wv exchanged:
/// the parameters depend on the light. Around its peak, the logarithm of a term is quadratic in the tangent plane of
/// the half vector or of the light, which makes it a lobe at wv like the others. `brdf` must outlive this.
class ExchangedLobes {
 public:
  explicit ExchangedLobes(const ParametricBrdf& brdf);

  /// Finds the peak by Newton's method; none if there is no peak, or if it is as broad as the hemisphere.
  std::optional<ReachedLobe> at(int lobe, const Vec3d& wv) const;
  /// Ratio of g_j to `seen`, its lobe at wv, at wl.
  double growth(int lobe, const ReachedLobe& seen, const Vec3d& wl, const Vec3d& wv) const;
  /// g_j, 1/sr.
  Vec3d value(int lobe, const Vec3d& wl, const Vec3d& wv) const;

 private:
  struct Light {
    Vec3d wl;
    std::vector<WarpedLobe> lobes;
  };
  Vec3d brightest(int lobe, const Vec3d& wv) const;

  const ParametricBrdf& brdf_;
  std::vector<Light> lights_;
};

// Least-squares fit of the broad part of a slice of f cos: a clipped cosine and a few Gaussians with fixed centers, in
// addition to the slice's own Gaussians.

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
