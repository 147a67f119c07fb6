// A whole BTF in memory, for random access.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/half_floats.h"
#include "btf/pair_interpolation.h"

namespace velour {

/// f in 1/sr as in BtfMeasurement, with mip levels that hold means of f over areas. Texels come before lights because
/// shading looks up many lights at one place. All values are finite. Immutable.
struct BtfTable {
  struct Level {
    uint32_t width = 0, height = 0;
    std::vector<HalfBits> value;  // [view][row][column][light][channel], row 0 at the bottom
  };
  PairInterpolation between;
  size_t lights = 0;
  std::vector<Level> levels;  // finest first; each half the size of the previous one, down to one texel

  /// Values of all lights, 3 each.
  const HalfBits* row(size_t level, uint32_t view, uint64_t texel) const {
    const Level& of = levels[level];
    return of.value.data() + (view * (uint64_t{of.width} * of.height) + texel) * lights * 3;
  }
};

/// Default memory limit, enough for 256 x 256 texels and 81 x 81 directions.
inline constexpr uint64_t kUsualTableBytes = uint64_t{4} << 30;

/// Reads the BTF view by view, buffering one view's images. Entries that are not finite become the mean of their image.
/// Throws Error(unsupported) if pairs are missing or the table would exceed `most_bytes`, and what read_pairs() throws.
std::shared_ptr<const BtfTable> read_btf_table(const BtfMeasurement& btf, uint64_t most_bytes = kUsualTableBytes);

}  // namespace velour
