// Materials sampled from a per-view SRBF model: the model itself, or a raw measurement with the model as its proposal
// (reference mode).
#pragma once

#include <memory>

#include "brdf/measure/measurement.h"
#include "brdf/model/per_view_brdf.h"
#include "material/material.h"

namespace velour {

/// f and samples of the model. `neighbors` 0: the model's default.
std::shared_ptr<const Material> make_per_view_material(std::shared_ptr<const PerViewBrdf> brdf, int neighbors);

/// f of the measurement, samples of the model: unbiased whatever the model's error.
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       std::shared_ptr<const PerViewBrdf> proposal, int neighbors);

}  // namespace velour
