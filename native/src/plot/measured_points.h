// Measured values in the plane of incidence of one view.
#pragma once

#include <vector>

#include "brdf/measurement.h"
#include "plot/model_plots.h"
#include "plot/plot.h"

namespace velour {

/// Light direction in the plane of incidence of views of azimuth `phi` (radians), `degrees` from the normal, positive
/// on the side opposite the viewer.
Vec3 light_in_plane(double degrees, double phi);

/// Luminance of f cos(theta_l) against the signed theta_l in degrees, sorted. Tables: interpolated every two
/// degrees, and closer around the mirror direction, where they cover the pair. Irregular samples: those within 2.5
/// degrees of the view and of the plane.
std::vector<PlotPoint> measured_points(const Measurement& measurement, const PlotView& view);

}  // namespace velour
