// How much of the light that arrives from all sides is reflected to one view.
#pragma once

#include "brdf/measurement.h"
#include "material/material.h"

namespace velour {

/// The integral of f cos over the lights, of each channel.
Vec3d directional_albedo(const Material& material, const Vec3& wv);

struct MeasuredAlbedo {
  Vec3d albedo{0};     // of the lights that the measurement covers
  double covered = 0;  // the share of the integral of the cosine that these have
};
MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv);

}  // namespace velour
