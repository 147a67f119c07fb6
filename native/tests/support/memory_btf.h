// BTFs made of a formula, in memory.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "btf/measure/btf_measurement.h"

namespace velour::test {

/// f of a texel (its column and row) for a pair.
using BtfFormula = std::function<Rgb(const DirectionPair&, uint32_t x, uint32_t y)>;

class MemoryBtf final : public BtfMeasurement {
 public:
  MemoryBtf(PairLayout layout, TexelGrid grid, const BtfFormula& f) {
    layout_ = std::move(layout);
    grid_ = grid;
    std::vector<float> values;
    for (uint64_t pair = 0; pair < layout_->pairs(); ++pair) {
      for (uint32_t y = 0; y < grid.height; ++y) {
        for (uint32_t x = 0; x < grid.width; ++x) {
          const Rgb value = f(layout_->directions(pair), x, y);
          values.insert(values.end(), {value.r, value.g, value.b});
        }
      }
    }
    halves_.resize(values.size());
    floats_to_halves(values, halves_);
  }
  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    const size_t image = grid_.texels() * 3;
    check_range(first, count);
    std::copy_n(halves_.begin() + static_cast<ptrdiff_t>(first * image), count * image, values.begin());
  }

 private:
  std::vector<HalfBits> halves_;
};

}  // namespace velour::test
