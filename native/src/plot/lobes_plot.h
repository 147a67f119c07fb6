// A model in the plane of incidence of one view.
#pragma once

#include <memory>

#include "brdf/measurement.h"
#include "model/model.h"
#include "plot/model_plots.h"
#include "plot/plot.h"

namespace velour {

/// Luminance of f cos(theta_l) against the signed theta_l, for the model of a BRDF, each of its lobes, and the
/// measurement: interpolated, or the samples themselves that lie near view and plane. The radius is logarithmic if one
/// peak would hide everything else.
Plot lobes_plot(const std::shared_ptr<const Model>& model, const Measurement* measurement, const PlotView& view);

}  // namespace velour
