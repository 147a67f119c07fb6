// Where `product` had better draw towards lights than from products of lobes.
#pragma once

#include "scene/scene.h"

namespace velour {

class SkyProposals;

/// Of the products' share of the directions (kProductShare), what the lights draw in their place: half, or nothing. By
/// material; the same at every vertex of one, for the points of a sequence stay evenly spread only where all vertices
/// deal them alike.
///
/// Under a sun half for all: SkyProposals says why. Lamps of a studio are the same at a smaller scale: their edges are
/// blurred in a mixture of few Gaussians. A highlight blurs them as well, so that its products lose nothing; a diffuse
/// material sees them sharp, and there the lights' own density, one smooth map of the unit square, is the better half.
std::vector<float> lights_parts(const Scene& scene, const SkyProposals& sky);

/// Of what the material's proposals reflect of even light, the share in lobes as broad as a cosine; mean over views.
/// 0 where it has no lobes.
double broad_share(const Material& material);

}  // namespace velour
