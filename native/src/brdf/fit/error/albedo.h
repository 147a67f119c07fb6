// Directional albedo: the radiance reflected to a view under uniform light of radiance 1.
#pragma once

#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "brdf/model/parametric_brdf.h"
#include "material/material.h"

namespace velour {

/// Integral of f cos over the light directions, per channel.
Vec3d directional_albedo(const Material& material, const Vec3& wv);

struct MeasuredAlbedo {
  Vec3d albedo{0};     // over the light directions that the measurement covers
  double covered = 0;  // their share of the integral of the cosine
};
MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv);

// Limits the directional albedo of a parametric model to 1.

/// Lowers the coefficients of `brdf` until no channel of its directional albedo exceeds 1, tested at views half a
/// degree apart. f does not change at views beyond the spline support of those that exceed 1. Control values stay half
/// floats. Returns whether anything changed.
bool limit_albedo(ParametricBrdf& brdf, int threads, const Progress& progress);

}  // namespace velour
