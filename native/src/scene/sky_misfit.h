// Misfit of a mixture of lobes as a sampling density of its environment.
#pragma once

#include "scene/sky_mixture.h"

namespace velour {

/// Chi-square of the environment's own density p (Environment::sample) against the density q of the mixture's
/// luminance,
///   int p^2 / q dw - 1,
/// from 1024 evenly spread samples of p: the variance over the squared mean of the light on a receiver that weights all
/// directions equally, when directions are sampled from q. 0 if both agree, 0.1 to 0.3 if lights have sharp edges,
/// which Gaussians cannot represent; infinite if the mixture misses a light. Neither may be black. Deterministic.
double sky_misfit(const Environment& environment, const SkyMixture& sky);

}  // namespace velour
