// The analytic material of the scene's other objects, from the Principled parameters.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/principled_lobes.h"

namespace velour {

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters);

}  // namespace velour
