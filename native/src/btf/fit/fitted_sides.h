// The sides of a BTF that need to be fitted.
#pragma once

#include "base/progress.h"
#include "btf/fit/color_axes.h"
#include "btf/fit/side_views.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/srbf_btf.h"

namespace velour {

struct FittedSide {
  SideDirections directions;
  double energy = 0;  // sum of squares of all companded values of this side and of those that share it
};

struct FittedSides {
  std::vector<FittedSide> sides;
  std::vector<SharedSide> shared;
};

/// All sides except those without transmitted light (missing sides are black) and those that share another side
/// (sides_are_equal).
FittedSides fitted_sides(const BtfMeasurement& measurement, const ColorAxes& colors, const Progress& progress);

/// Throws Error(unsupported) if a view lacks a light.
void require_complete(const PairLayout& layout);

// Detection of equal sides of a BTF.

/// Whether the images of two sides, each in its own mirrored frame, differ by no more than their standard errors and
/// the rounding of half floats explain, per texel and in the means over the tile. False if their directions differ.
/// Reads both sides view by view and stops at the first view that shows a difference.
bool sides_are_equal(const BtfMeasurement& measurement, const SideDirections& a, const SideDirections& b,
                     const Progress& progress);

}  // namespace velour
