// Counts of invalid values in a BTF, for reports; the data is left as it is.
#pragma once

#include <cstdint>
#include <span>

#include "btf/half_floats.h"

namespace velour {

struct ValueCounts {
  uint64_t values = 0;      // channels of the texels examined
  uint64_t not_finite = 0;  // NaN or infinite; excluded from fits
  uint64_t negative = 0;    // below 0: colors outside Rec. 709 or camera noise; kept

  void add(std::span<const HalfBits> halves);
  ValueCounts& operator+=(const ValueCounts& other);
  bool operator==(const ValueCounts&) const = default;
};

}  // namespace velour
