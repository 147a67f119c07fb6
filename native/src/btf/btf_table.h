// All of a BTF in memory, ready to be looked up in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/half_floats.h"
#include "btf/pair_interpolation.h"

namespace velour {

/// f in 1/sr, as BtfMeasurement has it, with mip levels: means of f over areas. Texels before lights, because whoever
/// shades a point looks up many lights at one place. All values are finite. Immutable.
struct BtfTable {
  struct Level {
    uint32_t width = 0, height = 0;
    std::vector<HalfBits> value;  // [view][row][column][light][channel], row 0 at the bottom
  };
  PairInterpolation between;
  size_t lights = 0;
  std::vector<Level> levels;  // the finest first; each half of the one before, down to one texel

  /// Of all lights: 3 values each.
  const HalfBits* row(size_t level, uint32_t view, uint64_t texel) const {
    const Level& of = levels[level];
    return of.value.data() + (view * (uint64_t{of.width} * of.height) + texel) * lights * 3;
  }
};

/// Enough for 256 x 256 texels under 81 x 81 directions.
inline constexpr uint64_t kUsualTableBytes = uint64_t{4} << 30;

/// Reads it view by view; for that it holds one view's images more. Entries that are not finite become the mean of
/// their image. Throws Error(unsupported) where pairs are missing, or where the table takes more than `most_bytes`, and
/// what read_pairs() throws.
std::shared_ptr<const BtfTable> read_btf_table(const BtfMeasurement& btf, uint64_t most_bytes = kUsualTableBytes);

}  // namespace velour
