// Materials sampled from a parametric model: the model itself, or a raw measurement.
#pragma once

#include <memory>

#include "brdf/measurement.h"
#include "brdf/parametric_brdf.h"
#include "material/material.h"

namespace velour {

/// f and samples of the model. Throws Error(invalid_argument) when it has more lobes than WarpedMixture::kCapacity.
std::shared_ptr<const Material> make_parametric_material(const std::shared_ptr<const ParametricBrdf>& brdf);

/// f of the measurement, samples of the model: unbiased whatever the model's error (reference mode).
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const ParametricBrdf>& proposal);

}  // namespace velour
