// The analytic material of the scene's other objects: diffuse plus GGX, from the Principled parameters.
#pragma once

#include <memory>

#include "material/material.h"

namespace velour {

struct PrincipledParameters {
  Rgb base_color{0.8f, 0.8f, 0.8f};
  float metallic = 0;
  float roughness = 0.5f;  // alpha = roughness^2
  float specular = 0.5f;   // 0.5: index 1.5
};

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters);

}  // namespace velour
