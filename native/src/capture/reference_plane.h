// The height of the reference plane.
#pragma once

#include "capture/repeated_tile.h"
#include "job/progress.h"

namespace velour {

/// The height (scene's z) at which texels look most alike from all sides: of kReferenceHeights heights, evenly spaced
/// from bottom to top, the one whose texel values vary least over views. Views: the normal and six each at 30 and 60
/// degrees; lights: the normal and three at 45 degrees, each compared with itself alone; `two_sided` adds the mirror
/// images below. Values are luminance x |cos(theta_l)| of the first hit, averaged over texels. They vary because
/// features off the plane move across texels from view to view. A flat tile has only one height.
///
/// Runs in the calling task arena. The result depends on the tile alone, so that all captures of it show the same
/// texels.
float least_variance_height(const RepeatedTile& tile, bool two_sided, Progress& progress);

inline constexpr int kReferenceHeights = 33;

}  // namespace velour
