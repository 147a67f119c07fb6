// The Principled material that comes closest to a measurement: what an artist would set by hand, at best.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/principled_point.h"

namespace velour {

/// What a fit may use of the Principled material.
enum class PrincipledSet {
  all,
  plain,  // base colour, metallic, roughness and specular: what Blender before 4.0 and other programs have as well
};

/// Least squares on sqrt(f cos) over the pair_samples of the measurement, as fit_ggx. Starts: eight kinds between
/// dielectric and metal, bare and coated, each at eight roughnesses over the range, with the base colour that suits;
/// the best roughness of each kind goes on by Levenberg-Marquardt. What is not in `set` stays at white tints and no
/// coat. Does not depend on `threads` (0: all). A black diffuse material without samples.
PrincipledParameters fit_principled(const Measurement& measurement, PrincipledSet set, int threads, Progress& progress);

}  // namespace velour
