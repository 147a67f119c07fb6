// The record of a fit: errors, albedos, and warnings about the fit and about the measurement.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/fit_model.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "math/sphere/view_spline.h"

namespace velour {

// Warnings about the measurement itself, which no fit can fix.

/// Appends to `record.warnings` one warning for each of: many invalid entries, few irregular samples,
/// irregular samples of an anisotropic surface, noise above the tolerance, lights that are not covered, no covered
/// view, no or almost no reflected light (a wrong scale), and broken reciprocity. All other fields of `record` must be
/// set.
void warn_of_measurement(const Measurement& measurement, const Comparison& errors, FitRecord& record);

// Tests whether irregular samples are of an isotropic surface.

/// Medians of |log(f1 / f2)| over the luminances of pairs of samples whose half and difference angles [R98] agree
/// within three degrees. For an isotropic surface both are similar; for a brushed one `turned` is larger.
struct AzimuthSpread {
  double alike;   // azimuths of the half vectors within 15 degrees of each other, modulo half a turn
  double turned;  // 30 degrees or more apart
  size_t turned_pairs;
};

/// Nothing if there are fewer than 100 such pairs of either kind, too few to tell.
std::optional<AzimuthSpread> azimuth_spread(std::span<const IrregularSample> samples);

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
/// (brdf/fit/slice_sampling.h).
double reciprocity_error(const Material& material, const Progress& progress);

/// Reciprocity error over the pairs that a measurement covers both ways. Nothing if there are none, and for irregular
/// samples, whose interpolation assumes reciprocity.
std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress);

}  // namespace velour
