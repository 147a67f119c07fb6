// Directional albedo against the view.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"
#include "plot/plot.h"

namespace velour {

/// By channel, at views of azimuth `phi` (radians). The measurement's own where it covers nearly all lights of a view.
Plot albedo_plot(const Material& material, const Measurement* measurement, double phi, Progress& progress);

}  // namespace velour
