// The first pass over a BTF: its colour axes, and how bright its pairs are.
#pragma once

#include <cstdint>
#include <vector>

#include "compress/companded_views.h"
#include "compress/fit_checkpoint.h"

namespace velour {

struct ColourAxes {
  Mat3 axes{1.0f};
  std::vector<double> energy;  // sum of squares of companded values, [view][light]
  uint64_t not_finite = 0;

  size_t lights = 0;

  double energy_of(const std::vector<uint32_t>& views, const std::vector<uint32_t>& of_lights) const;
  double all_energy() const;
};

/// Sets the axes of `views`, of a complete layout; reads every view once, or what a checkpoint has kept.
ColourAxes find_colours(CompandedViews& views, const PairLayout& layout, FitCheckpoint& checkpoint);

}  // namespace velour
