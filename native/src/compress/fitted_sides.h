// The sides of a BTF that a fit has to make.
#pragma once

#include "btf/sides.h"
#include "compress/colour_axes.h"
#include "compress/side_views.h"

namespace velour {

struct FittedSide {
  SideDirections directions;
  double energy = 0;  // sum of squares of all its companded values, and of those of the sides that it serves
};

struct FittedSides {
  std::vector<FittedSide> sides;
  std::vector<SharedSide> shared;
};

/// Without those that no light goes through to: what no side shows is black. And without those that another one
/// serves (sides_are_equal).
FittedSides fitted_sides(const BtfMeasurement& measurement, const ColourAxes& colours, const Progress& progress);

/// Throws Error(unsupported) for a layout in which a view lacks a light.
void require_complete(const PairLayout& layout);

}  // namespace velour
