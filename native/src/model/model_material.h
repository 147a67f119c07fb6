// From a model to its run-time evaluator.
#pragma once

#include <memory>

#include "brdf/measurement.h"
#include "material/material.h"
#include "model/model.h"

namespace velour {

/// f and samples of the model; shares it. `neighbors`: views of a scattered model that are mixed, 0: the model's
/// default.
std::shared_ptr<const Material> make_material(const std::shared_ptr<const Model>& model, int neighbors);

/// The same for light from the viewer's side alone, where a model of a BTF knows more.
std::shared_ptr<const Material> make_reflecting_material(const std::shared_ptr<const Model>& model, int neighbors);

/// Reference mode: f of the measurement, samples of the model, unbiased whatever the model's error.
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const Model>& proposal, int neighbors);

}  // namespace velour
