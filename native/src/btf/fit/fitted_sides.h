// First pass over a BTF: its color axes, the energies of its pairs, and the sides that need to be fitted.
#pragma once

#include <cstdint>
#include <vector>
#include "base/progress.h"
#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/side_views.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/srbf_btf.h"

namespace velour {

struct ColorAxes {
  Mat3 axes{1.0f};
  std::vector<double> energy;  // sum of squares of companded values, [view][light]
  uint64_t not_finite = 0;

  size_t lights = 0;

  double energy_of(const std::vector<uint32_t>& views, const std::vector<uint32_t>& of_lights) const;
  double all_energy() const;
  /// Number of views that are not black.
  size_t lit_views() const;
};

/// Finds the color axes and sets them in `views`, of a complete layout; reads every view once, or the checkpoint.
ColorAxes find_colors(CompandedViews& views, const PairLayout& layout, FitCheckpoint& checkpoint);

// The sides of a BTF that need to be fitted.

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
