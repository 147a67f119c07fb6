// The sides of a BTF that need to be fitted.
#pragma once

#include "btf/sides.h"
#include "compress/colour_axes.h"
#include "compress/side_views.h"

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
FittedSides fitted_sides(const BtfMeasurement& measurement, const ColourAxes& colours, const Progress& progress);

/// Throws Error(unsupported) if a view lacks a light.
void require_complete(const PairLayout& layout);

}  // namespace velour
