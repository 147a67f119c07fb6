// Lobes that cannot matter at a view.
#pragma once

#include <cstdint>

#include "material/light_points.h"

namespace velour {

/// What may be left out at a view, all lobes together: parts of the albedo, of the L2 norm of f cos, and of f itself at
/// every light direction.
inline constexpr double kIdleAlbedo = 1e-3, kIdleNorm = 1e-3, kIdleValue = 1e-2;

/// A bit for each of up to 32 lobes that has to stay, by their own `points` at the view. The least go first, each
/// counted by its largest channel against the luminance of all, until one more would take what is left out beyond these
/// bounds.
uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points);

}  // namespace velour
