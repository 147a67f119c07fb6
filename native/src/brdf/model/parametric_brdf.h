// The parametric BRDF model: a few lobes whose parameters vary with the view direction.
#pragma once

#include <array>
#include <cstdint>
#include <vector>
#include "math/sphere/vec.h"
#include "math/sphere/view_spline.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

/// f(wl, wv) = sum_j beta_j(wv) exp(lambda_j(wv) (psi_j . xi_j(wv) - 1)) above the horizon, without cosine: each lobe
/// in its own space (math/srbf/warped_lobe.h), its parameters quadratic B-splines of the view
/// (math/sphere/view_spline.h). The splines of bandwidth and coefficients are of their logarithms, so that both are
/// positive everywhere. Isotropic: the frame turns with the view (x along its azimuth), lobes lie in the plane of
/// incidence, f is symmetric about it, and the stretch fades at the normal, so that f is continuous there. Otherwise
/// the frame is that of the surface. Plain data; immutable once inside a Model.
struct ParametricBrdf {
  static constexpr int kMaxLobes = 32;
  /// Indices of the parameters of a lobe.
  enum Isotropic { kLogBandwidth, kLogRed, kLogGreen, kLogBlue, kTiltX, kStretchA, kIsotropicCount };
  enum Anisotropic { kTiltY = kIsotropicCount, kStretchB, kAnisotropicCount };
  static constexpr int parameters_of(bool is_isotropic) {
    return is_isotropic ? static_cast<int>(kIsotropicCount) : static_cast<int>(kAnisotropicCount);
  }

  bool isotropic = true;
  int cells = 0;  // number of spline cells
  /// The fitted views; views beyond them have the parameters of the nearest fitted view.
  ViewRange views;
  /// f is averaged over both orders of light and view, which makes it reciprocal for any lobes.
  bool symmetric = false;
  std::vector<LobeSpace> space;
  /// [node][parameter][lobe]: radians for tilts, logarithms elsewhere.
  std::vector<float> control;

  int lobe_count() const { return static_cast<int>(space.size()); }
  int parameter_count() const { return parameters_of(isotropic); }
  ViewSpline spline() const { return {isotropic, cells, views}; }
  size_t index(int node, int parameter, int lobe) const {
    return (static_cast<size_t>(node) * static_cast<size_t>(parameter_count()) + static_cast<size_t>(parameter)) *
               space.size() +
           static_cast<size_t>(lobe);
  }
  /// Bytes of the coefficients alone: half floats, and a byte per lobe for its space.
  static constexpr uint64_t parameter_bytes(uint64_t values, uint64_t lobes) { return 2 * values + lobes; }
  uint64_t parameter_bytes() const { return parameter_bytes(control.size(), space.size()); }
};

/// The parameters of one lobe, indexed by ParametricBrdf::Isotropic and Anisotropic.
using LobeParameters = std::array<double, ParametricBrdf::kAnisotropicCount>;
/// The lobe in the splines' frame, with the exponents of its stretch scaled by `fade`.
WarpedLobe lobe_of(const LobeParameters& parameters, LobeSpace space, double fade);
/// Inverse of lobe_of() without fade, for bandwidth, tilt and stretch; keeps the coefficients in `parameters`.
void store_shape(const WarpedLobe& lobe, LobeParameters& parameters);

/// f of `brdf` in 1/sr at a pair of unit directions above the horizon.
Vec3d value_of(const ParametricBrdf& brdf, const Vec3d& wl, const Vec3d& wv);
/// The sum of `lobes`, which must be those at `wv`.
Vec3d value_of(const std::vector<WarpedLobe>& lobes, const Vec3d& wl, const Vec3d& wv);

/// The lobes at `wv` (unit, above the horizon) in the surface's frame: the scalar reference. Lobes of isotropic models
/// are rotated by the view's azimuth.
std::vector<WarpedLobe> lobes_at(const ParametricBrdf& brdf, const Vec3d& wv);
/// One lobe of lobes_at().
WarpedLobe lobe_at(const ParametricBrdf& brdf, const Vec3d& wv, int lobe);

// Ranges of the control values of the parametric model. A spline's value lies between its control values, so a model
// within these ranges stays within them at every view. Fits stay well inside; a file outside is refused.

struct ParameterRange {
  float least, most;
  const char* name;

  bool holds(float value) const { return value >= least && value <= most; }  // NaN: no
};

/// Bandwidths of 1e-5 to 1e9, coefficients of e^-40 (nothing) to 1e12 1/sr, tilts up to half a turn, stretches up to
/// e^6 along an axis.
constexpr ParameterRange parameter_range(int parameter) {
  switch (parameter) {
    case ParametricBrdf::kLogBandwidth:
      return {-11.5f, 20.72f, "logarithm of the bandwidth"};
    case ParametricBrdf::kLogRed:
    case ParametricBrdf::kLogGreen:
    case ParametricBrdf::kLogBlue:
      return {-40.0f, 27.6f, "logarithm of the coefficient"};
    case ParametricBrdf::kTiltX:
    case ParametricBrdf::kTiltY:
      return {-kPi, kPi, "tilt in radians"};
    default:
      return {-6.0f, 6.0f, "stretch"};
  }
}

}  // namespace velour
