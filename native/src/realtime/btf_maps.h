// A BTF of multivariate SRBFs as the maps that a shader interpolates.
#pragma once

#include <vector>

#include "btf/srbf_btf.h"
#include "realtime/table_pixels.h"

namespace velour {

/// One side of a BTF, f = expanded(axes s) as in btf/srbf_btf.h. `layers` stand one above the other in `maps`, each of
/// maps.height / layers rows: four coefficients a layer, in the order of `terms` and zeros to the end, then one of the
/// relief: height over the reference plane in widths of the tile, and its slope, two numbers. A layer has all levels of
/// the pyramid beside one another, each with a border of one pixel that repeats the tile.
struct BtfMaps {
  struct Level {
    uint32_t x, width, height;  // of the first pixel within the border; it is in the second row
  };
  /// A coefficient: what it multiplies, and the colour of its axis.
  struct Term {
    MultivariateLobe lobe;
    bool in_tile;  // a function in the tile's frame, else in that of the relief's normal
    Vec3 color;
  };

  uint32_t layers = 0;
  std::vector<Level> levels;
  std::vector<Term> terms;
  float bottom = 0, top = 0, aspect = 1;  // of the finest relief
  TablePixels maps = {};
};

/// What is seen from above under light from above, and, where the BTF has one of its own, what is seen from below under
/// light from below: both are looked at mirrored to z > 0. Throws Error(invalid_argument) of a BTF without the first.
std::vector<BtfMaps> btf_maps(const SrbfBtf& btf);

}  // namespace velour
