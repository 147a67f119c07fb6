// Detection of equal sides of a BTF.
#pragma once

#include "btf/btf_measurement.h"
#include "compress/side_views.h"
#include "job/progress.h"

namespace velour {

/// Whether the images of two sides, each in its own mirrored frame, differ by no more than their standard errors and
/// the rounding of half floats explain, per texel and in the means over the tile. False if their directions differ.
/// Reads both sides view by view and stops at the first view that shows a difference.
bool sides_are_equal(const BtfMeasurement& measurement, const SideDirections& a, const SideDirections& b,
                     const Progress& progress);

}  // namespace velour
