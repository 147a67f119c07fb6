// Light directions between which no highlight hides.
#pragma once

#include <vector>

#include "material/material.h"

namespace velour {

/// Directions above the horizon and the solid angles (sr) that they stand for.
struct WeightedLights {
  std::vector<Vec3> wl;
  std::vector<double> weight;
};

/// Directions for the error of `material` at the view `wv`: equal-area directions joined with rings about the mirror
/// direction of `wv` and about `wv` itself, whose radii grow geometrically from a ten-thousandth of a radian: the two
/// places where measured materials are sharp are seen at every scale. So are narrow lobes of the material itself,
/// wherever they are, by directions that its own sampler draws. Weights are one over the summed densities of the four
/// sets, the balance heuristic [VG95] as a quadrature.
WeightedLights close_lights(const Material& material, const Vec3& wv);

}  // namespace velour
