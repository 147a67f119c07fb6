// The Principled material that comes closest to a measurement: what an artist would set by hand, at best.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/principled_lobes.h"

namespace velour {

/// Least squares on sqrt(f cos) over the pair_samples of the measurement, as fit_ggx. Starts: roughness over its range,
/// each as metal and as dielectric, bare and under a smooth and a rough coat, with the base colour that suits it; the
/// best roughness of each of these six kinds goes on by Levenberg-Marquardt. Does not depend on `threads` (0: all).
/// A black diffuse material without samples.
PrincipledParameters fit_principled(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour
