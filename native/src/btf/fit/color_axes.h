// First pass over a BTF: its color axes and the energies of its pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/fit/companded_views.h"
#include "btf/fit/fit_checkpoint.h"

namespace velour {

struct ColorAxes {
  Mat3 axes{1.0f};
  std::vector<double> energy;  // sum of squares of companded values, [view][light]
  uint64_t not_finite = 0;

  size_t lights = 0;

  double energy_of(const std::vector<uint32_t>& views, const std::vector<uint32_t>& of_lights) const;
  double all_energy() const;
};

/// Finds the color axes and sets them in `views`, of a complete layout; reads every view once, or the checkpoint.
ColorAxes find_colors(CompandedViews& views, const PairLayout& layout, FitCheckpoint& checkpoint);

}  // namespace velour
