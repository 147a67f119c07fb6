// What a fit says of itself: errors, albedo, warnings.
#pragma once

#include <string>
#include <vector>

#include "brdf/measurement.h"
#include "fit/fit_options.h"
#include "material/material.h"
#include "sphere/view_range.h"

namespace velour {

/// Error of one view that was fitted.
struct FittedView {
  Vec3 wv;
  double relative_l2;
};

/// The tolerance that holds at polar angle `theta_v` (radians): twice as much beyond 75 degrees.
double tolerance_at(double tolerance, double theta_v);

/// Errors by compare(), albedos, and a sentence for each thing a user should know. `fitted` are the views of the model,
/// `views` the range that it is for: errors elsewhere are nobody's, and those of a part of the views are no promise of
/// a tolerance.
FitRecord report_fit(const Measurement& measurement, const Material& material, const FitOptions& options,
                     const std::vector<FittedView>& fitted, const ViewRange& views, Progress& progress);

}  // namespace velour
