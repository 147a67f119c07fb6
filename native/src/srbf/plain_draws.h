// Lobes of a warped mixture drawn from as they are.
#pragma once

#include "srbf/warped_mixture.h"

namespace velour {

/// Gives `mixture`, whose value is set, the density of its lobes in proportion to luminance times integral over psi,
/// without regard to horizon and cosine, with a share of `cosine` of the cosine about the normal.
void draw_plain_lobes(WarpedMixture& mixture, float cosine);

}  // namespace velour
