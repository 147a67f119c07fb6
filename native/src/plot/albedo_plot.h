// Directional albedo against the view angle.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"
#include "plot/plot.h"

namespace velour {

/// Albedo by channel at views of azimuth `phi` (radians), and that of the measurement at views whose lights it covers
/// almost entirely.
Plot albedo_plot(const Material& material, const Measurement* measurement, double phi, Progress& progress);

}  // namespace velour
