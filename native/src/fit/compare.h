// Error of a model against a measurement, as docs/engine/conventions.md defines it.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"
#include "model/model.h"

namespace velour {

struct Comparison {
  double relative_l2 = 0;  // mean over the covered views weighted by cos(theta_v); 1 if no view is covered
  ErrorByViewAngle by_view_angle;
  double log_rms = 0;                    // RMS of log(1 + f cos / 0.01) differences
  ErrorByViewAngle noise_by_view_angle;  // the measurement's own noise from mirror and reciprocal pairs
  /// Tables only: share of the light directions above the horizon that the measurement covers. Errors are over these.
  std::map<int, double> covered_share;
  uint64_t samples = 0;
  /// Views with a highlight too narrow for the 4096 directions: share of the measurement's energy that they capture.
  std::map<int, double> narrow_views;
};

/// Error at the held-out views 5, 30, 60, 75 and 85 degrees on 4096 equal-area light directions each; for irregular
/// samples, at the held-out ones. If the 4096 directions misjudge the energy of the measurement, if fewer than two of
/// them carry it, or if they understate the error (a narrow lobe of the model falls between them), the error of the
/// view is taken on close_lights() and the view is listed in `narrow_views`.
Comparison compare(const Measurement& measurement, const Material& material, Progress& progress);

}  // namespace velour
