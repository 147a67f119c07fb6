// Sampling density of a warped mixture from its own lobes.
#pragma once

#include "math/srbf/warped_mixture.h"

namespace velour {

/// Sets the density of `mixture`, whose value is already set: its lobes in proportion to luminance times integral over
/// psi, ignoring horizon and cosine, plus the cosine about the normal with a share of `cosine`.
void draw_plain_lobes(WarpedMixture& mixture, float cosine);

}  // namespace velour
