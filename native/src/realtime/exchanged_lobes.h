// The half of a symmetric model that exchanges light and view, as lobes of light.
#pragma once

#include <optional>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "realtime/light_gaussians.h"

namespace velour {

/// Half of f is g(wl) = 1/2 sum_j beta_j(wl) exp(lambda_j(wl) (psi_j . xi_j(wl) - 1)), psi_j with wl and wv exchanged:
/// the parameters are those of the light. About its peak the logarithm of a term is quadratic, in the tangent plane of
/// the half vector or of the light, which makes it a lobe of wv as others are. `brdf` has to outlive it.
class ExchangedLobes {
 public:
  explicit ExchangedLobes(const ParametricBrdf& brdf);

  /// By Newton's method; none where there is no peak, or one that is as broad as the hemisphere.
  std::optional<ReachedLobe> at(int lobe, const Vec3d& wv) const;
  /// g_j over what `seen`, its lobe at wv, is at wl.
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

}  // namespace velour
