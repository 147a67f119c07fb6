// How many values of a BTF are not as values should be: counted and told, never repaired.
#pragma once

#include <cstdint>
#include <span>

#include "btf/half_floats.h"

namespace velour {

struct ValueCounts {
  uint64_t values = 0;      // channels of texels that were looked at
  uint64_t not_finite = 0;  // NaN or infinite: fits leave them out
  uint64_t negative = 0;    // below 0: colours outside Rec. 709, or noise of a camera; kept as they are

  void add(std::span<const HalfBits> halves);
  ValueCounts& operator+=(const ValueCounts& other);
  bool operator==(const ValueCounts&) const = default;
};

}  // namespace velour
