// Makes the run-time evaluator of a model.
#pragma once

#include <memory>

#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "model/model.h"

namespace velour {

/// f and samples of the model, whose ownership it shares. `neighbors`: number of views mixed for a per-view model, 0:
/// the model's default.
std::shared_ptr<const Material> make_material(const std::shared_ptr<const Model>& model, int neighbors);

/// make_material() for light from the viewer's side only, without the transmission of a BTF.
std::shared_ptr<const Material> make_reflecting_material(const std::shared_ptr<const Model>& model, int neighbors);

/// Reference mode: f of the measurement, samples of the model, unbiased whatever the model's error.
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const Model>& proposal, int neighbors);

}  // namespace velour
