// How well a mixture of lobes pictures its environment, where draws are concerned.
#pragma once

#include "scene/sky_mixture.h"

namespace velour {

/// Chi-square of the environment's own density p (Environment::sample) against the density q of the mixture's
/// luminance,
///   int p^2 / q dw - 1,
/// by 1024 evenly spread draws of p: the variance, over its squared mean, of light on an even receiver when directions
/// are drawn from q. 0 when they agree, 0.1 to 0.3 where lamps have edges, which Gaussians have not; infinite where the
/// mixture leaves a light out. Neither is black. Deterministic.
double sky_misfit(const Environment& environment, const SkyMixture& sky);

}  // namespace velour
