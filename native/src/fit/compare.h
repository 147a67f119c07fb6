// Error of a model against a measurement, as docs/conventions.md defines it.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"
#include "model/model.h"

namespace velour {

struct Comparison {
  double relative_l2 = 0;  // mean over the covered views weighted by cos(theta_v)
  ErrorByViewAngle by_view_angle;
  double log_rms = 0;                    // RMS of log(1 + f cos / 0.01) differences
  ErrorByViewAngle noise_by_view_angle;  // the measurement's own noise from mirror and reciprocal pairs
  uint64_t samples = 0;
};

/// Held-out views 5, 30, 60, 75, 85 degrees on 4096 equal-area light directions each; scattered measurements at their
/// held-out samples.
Comparison compare(const Measurement& measurement, const Material& material, Progress& progress);

}  // namespace velour
