// Loops over the samples of a view: columns of lobes with their own parameterization and their derivatives, and sums
// of the residual. SIMD through Highway with run-time dispatch; the other linear algebra is in
// brdf/fit/slice_columns.h.
#pragma once

#include "brdf/fit/slice_columns.h"
#include "brdf/fit/slice_sampling.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

/// The shape of a lobe at one view, in the parameters of the fit.
struct WarpedShape {
  LobeSpace space = LobeSpace::light;
  double log_bandwidth = 0;
  double tilt_x = 0, tilt_y = 0;        // radians
  double stretch_a = 0, stretch_b = 0;  // logarithms
};

/// out_i = sqrt(weight_i) cos(theta_i) G(psi(wl_i)).
void fill_warped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, float* out);

/// fill_warped's column as `value`, and its derivatives by log bandwidth, tilt_x, stretch_a, tilt_y, stretch_b: the
/// first `count`.
inline constexpr int kWarpedSlopes = 5;
void fill_warped_slopes(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, int count, float* value,
                        float* const out[kWarpedSlopes]);

/// project() of brdf/fit/slice_columns.h for this shape, over every `stride`-th block of kPadding samples.
Projection project_warped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples,
                          const float* const residual[3], size_t stride);

// Sums over the samples of a view's residual. SIMD through Highway with run-time dispatch.

/// Sums of the squares of a residual: of all, and of each sample's share. In float within a block, with the same number
/// of lanes on every machine, then in double.
struct ResidualSums {
  double all = 0, shared = 0;
};

/// `residual` and `share` have the same length, a multiple of SliceSamples::kPadding.
ResidualSums residual_sums(const AlignedFloats& residual, const AlignedFloats& share);

}  // namespace velour
