// Directional albedo: the radiance reflected to a view under uniform light of radiance 1.
#pragma once

#include "brdf/measurement.h"
#include "material/material.h"

namespace velour {

/// Integral of f cos over the light directions, per channel.
Vec3d directional_albedo(const Material& material, const Vec3& wv);

struct MeasuredAlbedo {
  Vec3d albedo{0};     // over the light directions that the measurement covers
  double covered = 0;  // their share of the integral of the cosine
};
MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv);

}  // namespace velour
