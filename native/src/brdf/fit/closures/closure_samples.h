// Values of a BRDF at the views and lights of a fit of closures.
#pragma once

#include <functional>
#include <span>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/error/compare.h"
#include "material/material.h"
#include "math/sphere/vec.h"

namespace velour {

/// f in 1/sr without cosine for each of `wl`; wv.z > 0. Thread-safe.
using ClosureSource = std::function<void(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f)>;

/// f cos at a view at `theta_v` (radians) in the x-z plane, not negative; a mean over azimuths unless isotropic.
std::vector<Rgb> closure_values(const ClosureSource& source, bool isotropic, float theta_v, std::span<const Vec3> wl);

/// About `count` light directions above the horizon for the view at `theta_v` (radians), and the solid angles (sr) that
/// they stand for: 30 % uniform over the hemisphere, 60 % about the mirror direction by GGX half vectors of alpha 0.04,
/// 0.12 and 0.35, 10 % about the viewer, with the balance heuristic [VG95]. The same on every call.
WeightedLights closure_lights(float theta_v, int count);

/// One view, as structure of arrays; unit directions in a frame whose +x-z plane holds the viewer.
struct ClosureViewSamples {
  static constexpr int kMax = 450;
  double theta_v = 0;  // radians
  int count = 0;
  alignas(64) float wl_x[kMax], wl_y[kMax], wl_z[kMax], h_x[kMax], h_y[kMax], h_z[kMax];
  alignas(64) float root_weight[kMax];                                         // square root of the solid angle
  alignas(64) float target[3][kMax];                                           // f cos times root_weight
  double albedo[3];                                                            // by the same quadrature
  double inverse_norm_sq[3], inverse_norm_sq_luminance, inverse_albedo_sq[3];  // of the targets, bounded
};

/// Samples at 36 views, 1.25 + 2.5 i degrees. Empty if the source is black. The result does not depend on `threads`.
std::vector<ClosureViewSamples> closure_samples(const ClosureSource& source, bool isotropic, int threads,
                                                Progress& progress);

}  // namespace velour
