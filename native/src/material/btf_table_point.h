// Rows of an uncompressed BTF at a hit.
#pragma once

#include <array>

#include "btf/half_floats.h"
#include "material/footprint_taps.h"

namespace velour {

/// Rows of lights of an uncompressed BTF to blend for a site and a view, and their weights.
struct BtfTablePoint {
  /// Maximum number of rows: footprint taps, two levels, four texels, three views.
  static constexpr int kMost = FootprintTaps::kMost * 2 * 4 * 3;
  struct Row {
    const HalfBits* lights;  // [light][channel]
    float weight;
  };
  std::array<Row, kMost> row;
  int count;
  bool back;  // a two-sided BTF seen from below
};

}  // namespace velour
