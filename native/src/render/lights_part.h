// Materials for which `product` samples lights instead of products of lobes.
#pragma once

#include "scene/scene.h"

namespace velour {

class SkyProposals;

/// Share of the products' directions (kProductShare) that light sampling takes over, by material: half, or nothing. The
/// same at all vertices of a material, since the points of a sequence stay even only if all vertices deal them alike.
///
/// Under a sun it is half for all materials; SkyProposals says why. Studio lights are the same at a smaller scale: a
/// mixture of few Gaussians blurs their edges. A highlight blurs them as well, so that its products lose nothing. A
/// diffuse material resolves them, and there light sampling, with one smooth map of the unit square, does better for
/// half of the directions.
std::vector<float> lights_parts(const Scene& scene, const SkyProposals& sky);

/// Share of the reflection of uniform light, according to the material's proposals, that is in lobes as broad as a
/// cosine; mean over views. 0 if it has no lobes.
double broad_share(const Material& material);

}  // namespace velour
