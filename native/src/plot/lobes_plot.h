// A model in the plane of incidence of one view.
#pragma once

#include <memory>
#include <vector>
#include "brdf/measure/measurement.h"
#include "model/model.h"
#include "plot/model_plots.h"
#include "plot/plot.h"

namespace velour {

/// Luminance of f cos(theta_l) against the signed theta_l, for the model of a BRDF, each of its lobes, and the
/// measurement: interpolated, or the samples themselves that lie near view and plane. The radius is logarithmic if one
/// peak would hide everything else.
Plot lobes_plot(const std::shared_ptr<const Model>& model, const Measurement* measurement, const PlotView& view);

// Measured values in the plane of incidence of one view.

/// Light direction in the plane of incidence of views of azimuth `phi` (radians), `degrees` from the normal, positive
/// on the side opposite the viewer.
Vec3 light_in_plane(double degrees, double phi);

/// Luminance of f cos(theta_l) against the signed theta_l in degrees, sorted. Tables: interpolated every two
/// degrees, and closer around the mirror direction, where they cover the pair. Irregular samples: those within 2.5
/// degrees of the view and of the plane.
std::vector<PlotPoint> measured_points(const Measurement& measurement, const PlotView& view);

}  // namespace velour
