// A model in the plane of incidence of one view.
#pragma once

#include "brdf/measurement.h"
#include "material/material.h"
#include "model/model.h"
#include "plot/model_plots.h"
#include "plot/plot.h"

namespace velour {

/// Luminance of f cos(theta_l) against the signed theta_l: of `material`, which is that of `model`, of each lobe, and
/// of the measurement: its interpolation, or the samples themselves that lie near view and plane. The radius is
/// logarithmic where one peak would leave nothing else to see.
Plot lobes_plot(const Model& model, const Material& material, const Measurement* measurement, const PlotView& view);

}  // namespace velour
