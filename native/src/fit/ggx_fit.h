// The best GGX lobe over a diffuse base for a measured material: what a renderer without Velour would use.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/ggx_sampler.h"
#include "material/material.h"

namespace velour {

/// Least squares on sqrt(f cos) over the pair_samples of the material. With q = f cos / albedo this is the Hellinger
/// distance of the densities q and p: to second order a quarter of their chi-square distance, the relative variance
/// that samples of p have in an estimate of the albedo.
/// Roughness is started from a scan of its whole range (ten times log-spaced, five ratios where f depends on the
/// azimuth of the view), reflectances by non-negative least squares; the three best starts go on by
/// Levenberg-Marquardt. Axes are those of the frame. The result does not depend on `threads` (0: all). Black without
/// samples.
GgxParameters fit_ggx(const Material& material, int threads, Progress& progress);
GgxParameters fit_ggx(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour
