// Independent samples from a stream of items, each with probability proportional to its weight.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "sphere/random.h"

namespace velour {

/// Every item receives the times of a Poisson process whose rate is its weight. The `count` earliest times of all are
/// kept, and the items they belong to are the samples: the marks of superposed Poisson processes are independent, with
/// probabilities proportional to the rates [Kin93 chapters 2 and 5]. (Keeping only the first time of each item would be
/// the reservoir of [ES06]: sampling without replacement, in which heavy items get less than their share.) The outcome
/// depends on the items but not on their order, so parts may be sampled separately and merged.
template <typename Item>
class DrawByWeight {
 public:
  explicit DrawByWeight(size_t count) : count_(count) {}

  struct Draw {
    uint64_t key;  // bits of the time; they sort like the times
    Item item;
  };

  /// `numbers`: random numbers of this item alone.
  void add(const Item& item, double weight, RandomStream numbers) {
    double time = 0;
    for (size_t i = 0; i < count_; ++i) {
      time -= std::log1p(-unit_double(numbers.next_bits())) / weight;
      const auto key = std::bit_cast<uint64_t>(time);
      if (key >= latest_) return;
      draws_.push_back({key, item});
      if (draws_.size() >= 2 * count_) trim();
    }
  }
  void add(const DrawByWeight& other) {
    draws_.insert(draws_.end(), other.draws_.begin(), other.draws_.end());
    if (draws_.size() > count_) trim();
  }
  /// The samples in ascending order of their keys.
  std::vector<Draw> sorted() const {
    std::vector<Draw> draws = draws_;
    std::ranges::sort(draws, {}, &Draw::key);
    if (draws.size() > count_) draws.erase(draws.begin() + static_cast<std::ptrdiff_t>(count_), draws.end());
    return draws;
  }

 private:
  static double unit_double(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
  void trim() {
    const auto last = draws_.begin() + static_cast<std::ptrdiff_t>(count_ - 1);
    std::ranges::nth_element(draws_, last, {}, &Draw::key);
    draws_.erase(last + 1, draws_.end());
    latest_ = draws_.back().key;
  }

  size_t count_;
  std::vector<Draw> draws_;
  uint64_t latest_ = std::numeric_limits<uint64_t>::max();  // later times are no longer among the samples
};

}  // namespace velour
