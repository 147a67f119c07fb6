// A BTF's rows of lights at a hit.
#pragma once

#include <array>

#include "btf/half_floats.h"
#include "material/footprint_taps.h"

namespace velour {

/// What the site and the view decide of an uncompressed BTF: which rows of lights are blended, and how.
struct BtfTablePoint {
  /// Taps of the footprint, two levels, four texels, three views.
  static constexpr int kMost = FootprintTaps::kMost * 2 * 4 * 3;
  struct Row {
    const HalfBits* lights;  // [light][channel]
    float weight;
  };
  std::array<Row, kMost> row;
  int count;
  bool back;  // of a BTF with two sides, seen from below
};

}  // namespace velour
