// BTFs in memory over a relief.
#pragma once

#include <cmath>

#include "support/memory_btf.h"

namespace velour::test {

/// A BTF in memory with heights of its own.
class MemoryBtfWithRelief final : public BtfMeasurement {
 public:
  /// Nothing is met where a height is not finite.
  MemoryBtfWithRelief(MemoryBtf values, std::vector<float> heights, Shell shell)
      : values_(std::move(values)), heights_(std::move(heights)) {
    layout_ = values_.layout();
    grid_ = values_.grid();
    shell_ = shell;
  }
  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    values_.read_pairs(first, count, values);
  }
  bool has_structure() const override { return true; }
  std::optional<ViewStructure> read_structure(uint32_t) const override {
    ViewStructure structure;
    for (const float height : heights_) {
      structure.coverage.push_back(std::isfinite(height) ? 1.0f : 0.0f);
      structure.height_mean.push_back(std::isfinite(height) ? height : 0.0f);
      structure.height_spread.push_back(0);
    }
    return structure;
  }

 private:
  MemoryBtf values_;
  std::vector<float> heights_;
};

}  // namespace velour::test
