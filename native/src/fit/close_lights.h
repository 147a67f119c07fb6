// Light directions dense enough to resolve any highlight.
#pragma once

#include <vector>

#include "material/material.h"

namespace velour {

/// Directions above the horizon and the solid angles (sr) that they represent.
struct WeightedLights {
  std::vector<Vec3> wl;
  std::vector<double> weight;
};

/// Directions for the error of `material` at the view `wv`: equal-area directions, rings about the mirror direction of
/// `wv` and about `wv` itself, and directions from the material's own sampler. The radii of the rings grow
/// geometrically from 1e-4 radians, so the two places where measured materials are sharp are resolved at every scale.
/// The sampled directions resolve narrow lobes of the material anywhere. Each weight is one over the summed densities
/// of the four sets: the balance heuristic [VG95] as a quadrature.
WeightedLights close_lights(const Material& material, const Vec3& wv);

}  // namespace velour
