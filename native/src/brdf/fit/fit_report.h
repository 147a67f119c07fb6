// The record of a fit: errors, albedos, warnings.
#pragma once

#include <optional>
#include <string>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/options.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "math/sphere/view_spline.h"

namespace velour {

/// Error of one fitted view.
struct FittedView {
  Vec3 wv;
  double relative_l2;
};

/// The tolerance at polar angle `theta_v` (radians): doubled beyond 75 degrees.
double tolerance_at(double tolerance, double theta_v);

/// Errors from compare(), albedos, and warnings for the user. `fitted` are the views of the model, `views` the range
/// that it is valid for. Errors outside the range are not reported; a model for part of the views is not checked
/// against the tolerance.
FitRecord report_fit(const Measurement& measurement, const Material& material, const FitOptions& options,
                     const std::vector<FittedView>& fitted, const ViewRange& views, Progress& progress);

// Deviation of a BRDF from reciprocity, f(wl, wv) = f(wv, wl).

/// Relative L2 of the difference of the luminances a = f(wl, wv) cos cos and b = f(wv, wl) cos cos over all pairs of
/// directions, sqrt(2 sum (a - b)^2 / sum (a^2 + b^2)): 0 if f is reciprocal, sqrt(2) if one of every pair is black.
/// Views: 16 of equal solid angle, on the meridian if isotropic. Lights: half vectors about each
/// (brdf/fit/view_grid.h).
double reciprocity_error(const Material& material, const Progress& progress);

/// Reciprocity error over the pairs that a measurement covers both ways. Nothing if there are none, and for irregular
/// samples, whose interpolation assumes reciprocity.
std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress);

}  // namespace velour
