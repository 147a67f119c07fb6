// Fits a GGX lobe over a diffuse base to a measured material, as a renderer without Velour would use.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/ggx_sampler.h"
#include "material/material.h"

namespace velour {

/// Least squares on sqrt(f cos) over the pair_samples of the material. With the density q = f cos / albedo of the
/// material and the density p of the fit, this is their Hellinger distance: to second order a quarter of their
/// chi-square distance, which is the relative variance of an estimate of the albedo with samples of p. Starting values
/// of the roughness scan its whole range (ten log-spaced values, times five aspect ratios if f depends on the azimuth
/// of the view), with reflectances by non-negative least squares; the three best starts are refined by
/// Levenberg-Marquardt. Axes are those of the frame. The result does not depend on `threads` (0: all). Black if there
/// are no samples.
GgxParameters fit_ggx(const Material& material, int threads, Progress& progress);
GgxParameters fit_ggx(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour
