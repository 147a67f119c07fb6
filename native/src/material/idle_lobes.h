// Finds lobes that are negligible at a view.
#pragma once

#include <cstdint>

#include "material/light_points.h"

namespace velour {

/// Limits for all lobes dropped at a view together, as fractions of the albedo, of the L2 norm of f cos, and of f
/// itself at every light direction.
inline constexpr double kIdleAlbedo = 1e-3, kIdleNorm = 1e-3, kIdleValue = 1e-2;

/// Bit mask of the lobes to keep, up to 32, judged at `points`, the quadrature of `lobes` at the view. Lobes are
/// dropped in order of increasing loss, which compares a lobe's largest channel with the luminance of all lobes, until
/// the next one would exceed these limits.
uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points);

}  // namespace velour
