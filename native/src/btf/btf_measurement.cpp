#include "btf/btf_measurement.h"

#include <algorithm>

#include "job/error.h"

namespace velour {

void BtfMeasurement::check_range(uint64_t first, uint64_t count) const {
  if (first <= layout().pairs() && count <= layout().pairs() - first) return;
  throw Error(Status::invalid_argument, provenance_.path + ": has " + std::to_string(layout().pairs()) +
                                            " view-light pairs; " + std::to_string(count) + " pairs from index " +
                                            std::to_string(first) + " are out of range.");
}

std::optional<std::vector<float>> BtfMeasurement::read_coverage(uint32_t view) const {
  auto structure = read_structure(view);
  return structure ? std::optional(std::move(structure->coverage)) : std::nullopt;
}

CountedPairs count_values(const BtfMeasurement& btf) {
  const uint64_t pairs = btf.layout().pairs();
  if (const auto counts = btf.all_counts()) return {pairs, *counts};
  constexpr uint64_t kMost = 16;
  constexpr uint64_t kRun = 4;  // pairs read together: in a compressed set, one costs nearly as much as four
  const uint64_t runs = pairs <= kMost ? 1 : kMost / kRun, run = pairs <= kMost ? pairs : kRun;
  std::vector<HalfBits> values(run * btf.grid().texels() * 3);
  CountedPairs counted{runs * run, {}};
  for (uint64_t i = 0; i < runs; ++i) {
    btf.read_pairs(i * (pairs - run) / std::max<uint64_t>(1, runs - 1), run, values);
    counted.counts.add(values);
  }
  return counted;
}

}  // namespace velour
