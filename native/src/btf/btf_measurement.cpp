#include "btf/btf_measurement.h"

#include <algorithm>

#include "job/error.h"

namespace velour {

void BtfMeasurement::check_range(uint64_t first, uint64_t count) const {
  if (first <= layout().pairs() && count <= layout().pairs() - first) return;
  throw Error(Status::invalid_argument, provenance_.path + ": has " + std::to_string(layout().pairs()) +
                                            " pairs of directions; " + std::to_string(count) + " from number " +
                                            std::to_string(first) + " on are not among them.");
}

CountedPairs count_values(const BtfMeasurement& btf, uint64_t most) {
  const uint64_t pairs = btf.layout().pairs();
  if (const auto counts = btf.all_counts()) return {pairs, *counts};
  CountedPairs counted{std::min(most, pairs), {}};
  std::vector<HalfBits> values(btf.grid().texels() * 3);
  for (uint64_t i = 0; i < counted.pairs; ++i) {
    btf.read_pairs(i * pairs / counted.pairs, 1, values);
    counted.counts.add(values);
  }
  return counted;
}

}  // namespace velour
