// Fits the Principled material to a measurement: the best that an artist could set by hand.
#pragma once

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/principled_point.h"

namespace velour {

/// Parameters of the Principled material that a fit may use.
enum class PrincipledSet {
  all,
  plain,  // base color, metallic, roughness and specular, which Blender before 4.0 and other programs also have
};

/// Least squares on sqrt(f cos) over the pair_samples of the measurement, as in fit_ggx. Starts: eight kinds (plain:
/// four) between dielectric and metal, bare and coated, each at eight roughnesses over the range, with the best base
/// color. The best roughness of each kind is refined by Levenberg-Marquardt. PrincipledSet::plain has white tints and
/// no coat. The result does not depend on `threads` (0: all). Black and diffuse if there are no samples.
PrincipledParameters fit_principled(const Measurement& measurement, PrincipledSet set, int threads, Progress& progress);

}  // namespace velour
