#include "btf/measure/btf_measurement.h"

#include <algorithm>
#include <cmath>
#include "base/error.h"

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

uint64_t mend_image(std::span<float> image) {
  uint64_t bad = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    double sum = 0;
    uint64_t good = 0, here = 0;
    for (size_t i = channel; i < image.size(); i += 3) {
      std::isfinite(image[i]) ? (sum += static_cast<double>(image[i]), ++good) : ++here;
    }
    bad += here;
    if (here == 0) continue;
    const float mean = good > 0 ? static_cast<float>(sum / static_cast<double>(good)) : 0.0f;
    for (size_t i = channel; i < image.size(); i += 3) {
      if (!std::isfinite(image[i])) image[i] = mean;
    }
  }
  return bad;
}

}  // namespace velour
