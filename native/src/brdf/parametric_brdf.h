// The parametric model of a BRDF: few lobes, followed over all view directions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sphere/view_spline.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// f(wl, wv) = sum_j beta_j(wv) exp(lambda_j(wv) (psi_j . xi_j(wv) - 1)) above the horizon, without cosine: each lobe
/// in its own space (srbf/warped_lobe.h), its parameters quadratic B-splines of the view (sphere/view_spline.h).
/// Bandwidth and coefficients are splines of their logarithms, so that they are positive everywhere.
/// Isotropic: the frame turns with the view (x along its azimuth), lobes lie in the plane of incidence, f is symmetric
/// about it, and the stretch fades at the normal, so that f is continuous there. Otherwise the frame is that of the
/// surface. Plain data; immutable once inside a Model.
struct ParametricBrdf {
  static constexpr int kMaxLobes = 32;
  /// Where a parameter of a lobe stands in its column.
  enum Isotropic { kLogBandwidth, kLogRed, kLogGreen, kLogBlue, kTiltX, kStretchA, kIsotropicCount };
  enum Anisotropic { kTiltY = kIsotropicCount, kStretchB, kAnisotropicCount };
  static constexpr int parameters_of(bool is_isotropic) {
    return is_isotropic ? static_cast<int>(kIsotropicCount) : static_cast<int>(kAnisotropicCount);
  }

  bool isotropic = true;
  int cells = 0;  // of the spline
  /// The views that it is fitted to; beyond them it has the parameters of the nearest of these.
  ViewRange views;
  /// f is the mean of this sum and of the one with light and view exchanged: reciprocal, whatever the lobes.
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
  /// Bytes of the coefficients alone: half floats, and a byte a lobe for its space.
  static constexpr uint64_t parameter_bytes(uint64_t values, uint64_t lobes) { return 2 * values + lobes; }
  uint64_t parameter_bytes() const { return parameter_bytes(control.size(), space.size()); }
};

/// The parameters of one lobe, by ParametricBrdf::Isotropic and Anisotropic.
using LobeParameters = std::array<double, ParametricBrdf::kAnisotropicCount>;
/// The lobe in the splines' frame; its stretch is `fade` times what they say.
WarpedLobe lobe_of(const LobeParameters& parameters, LobeSpace space, double fade);
/// The inverse without fade, of bandwidth, tilt and stretch; the coefficients in `parameters` stay.
void store_shape(const WarpedLobe& lobe, LobeParameters& parameters);

/// f, 1/sr, of `brdf` at a pair, both unit and above the horizon.
Vec3d value_of(const ParametricBrdf& brdf, const Vec3d& wl, const Vec3d& wv);
/// The sum of `lobes`, which are those at `wv`.
Vec3d value_of(const std::vector<WarpedLobe>& lobes, const Vec3d& wl, const Vec3d& wv);

/// The lobes at `wv` (unit, above the horizon), in the surface's frame: the scalar reference. Isotropic models turn
/// them by the view's azimuth.
std::vector<WarpedLobe> lobes_at(const ParametricBrdf& brdf, const Vec3d& wv);
/// One of them.
WarpedLobe lobe_at(const ParametricBrdf& brdf, const Vec3d& wv, int lobe);

}  // namespace velour
