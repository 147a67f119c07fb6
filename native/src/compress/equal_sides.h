// Sides of a BTF that look the same.
#pragma once

#include "btf/btf_measurement.h"
#include "compress/side_views.h"
#include "job/progress.h"

namespace velour {

/// Whether the images of two sides, each in its own mirrored frame, differ by no more than their standard errors and
/// the rounding of half floats explain: texel by texel, and in the means over the tile. False where their directions
/// differ. Reads both sides view by view, and ends at the first view that shows a difference.
bool sides_are_equal(const BtfMeasurement& measurement, const SideDirections& a, const SideDirections& b,
                     const Progress& progress);

}  // namespace velour
