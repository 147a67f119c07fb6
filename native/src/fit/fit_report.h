// The record of a fit: errors, albedos, warnings.
#pragma once

#include <string>
#include <vector>

#include "brdf/measurement.h"
#include "fit/fit_options.h"
#include "material/material.h"
#include "sphere/view_range.h"

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

}  // namespace velour
