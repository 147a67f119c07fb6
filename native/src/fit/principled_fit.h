// The Principled material that comes closest to a measurement: what an artist would set by hand, at best.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/principled_lobes.h"

namespace velour {

/// Least squares on sqrt(f cos) over the pair_samples of the measurement, as fit_ggx. Starts: eight kinds between
/// dielectric and metal, bare and coated, each at eight roughnesses over the range, with the base colour that suits;
/// the best roughness of each kind goes on by Levenberg-Marquardt. Does not depend on `threads` (0: all). A black
/// diffuse material without samples.
PrincipledParameters fit_principled(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour
