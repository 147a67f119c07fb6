// The material of a parametric model.
#pragma once

#include <memory>

#include "brdf/parametric_brdf.h"
#include "material/material.h"

namespace velour {

/// f and samples of the model. Throws Error(invalid_argument) when it has more lobes than WarpedMixture::kCapacity.
std::shared_ptr<const Material> make_parametric_material(const std::shared_ptr<const ParametricBrdf>& brdf);

}  // namespace velour
