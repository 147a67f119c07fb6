// Points of many sequences, generated together.
#pragma once

#include <span>

#include "math/sphere/sobol.h"

namespace velour {

/// Up to kCapacity points in [0, 1)^2: add, then resolve(), then read. Each sequence contributes only a few points;
/// vectors run over the points of all of them.
class PointBatch {
 public:
  static constexpr int kCapacity = 64;

  void clear() { count_ = 0; }
  int count() const { return count_; }
  /// Adds points `first`, `first` + 1, ... of the Sobol sequence `seeds`.
  void add(const SobolSeeds& seeds, uint32_t first, int count) {
    pending_ = true;
    for (uint32_t i = 0; i < static_cast<uint32_t>(count); ++i, ++count_) {
      index_[count_] = first + i;
      order_[count_] = seeds.order;
      seed_x_[count_] = seeds.x;
      seed_y_[count_] = seeds.y;
    }
  }
  /// Adds `count` points that the caller sets at once, for numbers without a sequence. Must not be mixed with the
  /// others.
  std::span<Vec2> add(int count) {
    count_ += count;
    return {points_ + count_ - count, static_cast<size_t>(count)};
  }
  /// Generates the requested points. Run-time dispatched SIMD; bit-identical to sobol_points.
  void resolve();

  std::span<const Vec2> points(int first, int count) const { return {points_ + first, static_cast<size_t>(count)}; }

  // Arguments of the kernel.
  struct Lanes {
    const uint32_t *index, *order, *seed_x, *seed_y;
    float* points;  // x and y interleaved
    int count;
  };

 private:
  int count_ = 0;
  bool pending_ = false;
  alignas(64) uint32_t index_[kCapacity] = {}, order_[kCapacity] = {}, seed_x_[kCapacity] = {}, seed_y_[kCapacity] = {};
  alignas(64) Vec2 points_[kCapacity];
};

}  // namespace velour
