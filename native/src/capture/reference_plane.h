// The height of the reference plane.
#pragma once

#include "capture/repeated_tile.h"
#include "job/progress.h"

namespace velour {

/// The height (scene's z) at which texels look most alike from all sides: of kReferenceHeights heights evenly from
/// bottom to top, the one whose texels' values vary least over views. Views: the normal and six each at 30 and 60
/// degrees; lights: the normal and three at 45 degrees, each compared with itself alone; `two_sided`: the same from
/// below. Values are luminance x |cos(theta_l)| of one surface, averaged over texels; a feature that lies off the plane
/// moves through the texels from view to view, which is what varies. A flat tile has one height only.
///
/// Call it in the arena that shall do the work. Depends on the tile alone, so that all captures of it
/// show the same texels.
float least_variance_height(const RepeatedTile& tile, bool two_sided, Progress& progress);

inline constexpr int kReferenceHeights = 33;

}  // namespace velour
