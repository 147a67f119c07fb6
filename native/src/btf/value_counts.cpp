#include "btf/value_counts.h"

namespace velour {

void ValueCounts::add(std::span<const HalfBits> halves) {
  constexpr HalfBits kInfinite = 0x7c00, kSign = 0x8000, kMagnitude = 0x7fff;
  uint64_t special = 0, below = 0;
  for (const HalfBits h : halves) {
    const bool finite = (h & kMagnitude) < kInfinite;
    special += !finite;
    below += finite && h > kSign;  // -0 is not negative
  }
  *this += {halves.size(), special, below};
}

ValueCounts& ValueCounts::operator+=(const ValueCounts& other) {
  values += other.values;
  not_finite += other.not_finite;
  negative += other.negative;
  return *this;
}

}  // namespace velour
