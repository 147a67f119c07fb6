// The two layouts of a plot. Internal to plot/.
#pragma once

#include "plot/pen.h"

namespace velour {

/// x to the right, y upwards.
void lay_out_cartesian(const Plot& plot, Pen& pen);

/// The upper half of a disk, with the surface's normal upwards; the radius is y.
void lay_out_polar(const Plot& plot, Pen& pen);

}  // namespace velour
