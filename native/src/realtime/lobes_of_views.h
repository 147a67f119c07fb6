// The lobes of a material at a view, before their conversion to Gaussians over light directions.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>
#include "brdf/model/parametric_brdf.h"
#include "material/principled/principled_material.h"
#include "math/srbf/warped_lobe.h"
#include "realtime/light_gaussians.h"

namespace velour {

// The half of a symmetric model with light and view exchanged, as lobes over light directions.

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

class LobesOfViews {
 public:
  virtual ~LobesOfViews() = default;
  virtual LobeOf of() const = 0;
  /// The lobes at a view; their number is the same at every view.
  virtual std::vector<ReachedLobe> lobes(const Vec3d& wv) const = 0;
  /// Ratio of lobe `j` of `lobes(wv)` at `wl` to the Gaussian of its argument there.
  virtual Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const = 0;
  /// f of the lobes marked in `soft`, plus everything that no lobe reflects.
  virtual Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const = 0;
};

/// A symmetric model has twice its lobes here: those of the view, then those of the light. `brdf` must outlive the
/// result.
std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf);
std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters);

// The highlight of a Principled material as lobes over half vectors.

/// GGX's distribution of normals is proportional to 1 / (1 + t^2)^2, t = tan(theta) / alpha: here a sum of Gaussians
/// exp(-s t^2), with an error of 1.5 % in L2 over t^2 and of 0.3 % in the total reflection.
class GgxLobes {
 public:
  static constexpr int kLobes = 4;
  explicit GgxLobes(const PrincipledParameters& parameters);

  /// Lobes of f cos at a view, with masking and Fresnel term evaluated at the mirror direction.
  std::vector<WarpedLobe> lobes(const Vec3d& wv) const;
  /// Masking and Fresnel term at a pair, relative to those at the mirror direction of its view.
  Vec3d growth(const Vec3d& wl, const Vec3d& wv) const;
  /// f without the highlight, and f of the whole material.
  Vec3d base(const Vec3d& wl, const Vec3d& wv) const;
  Vec3d f(const Vec3d& wl, const Vec3d& wv) const;

 private:
  double masking(double first, double second) const;  // of cosines to the normal [H14]

  PrincipledParameters parameters_;
  double alpha_;
  PrincipledMaterial whole_, base_;
};

}  // namespace velour
