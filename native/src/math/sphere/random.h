// Counter-based random numbers: every number is a pure function of (seed, stream, sample, dimension), so results do not
// depend on threads or on the order of tiles.
#pragma once

#include <algorithm>
#include <cstdint>
#include "math/sphere/vec.h"

namespace velour {

/// Finalizer of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64 bits with full avalanche.
inline uint64_t mix64(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Upper 24 bits of `bits` as a float in [0, 1); the largest value is 1 - 2^-24.
inline float unit_float(uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

/// Random numbers of one sample of one stream (a pixel, a texel, a facet ray). Cheap to construct; its only generator
/// state is a dimension counter.
class RandomStream {
 public:
  RandomStream(uint64_t seed, uint64_t stream, uint64_t sample)
      : key_(mix64(mix64(mix64(seed + kStep) + stream * kStep) + sample * kStep)) {}

  /// Next dimension, uniform in [0, 1).
  float next() { return unit_float(next_bits()); }
  Vec2 next2() {
    const float u = next();
    return {u, next()};
  }
  uint64_t next_bits() { return mix64(key_ + (++dimension_) * kStep); }

 private:
  static constexpr uint64_t kStep = 0x9e3779b97f4a7c15ULL;  // 2^64 / golden ratio: SplitMix64's increment
  uint64_t key_;
  uint64_t dimension_ = 0;
};

// Discrete sampling with a random number that is remapped for reuse.

/// Returns the index i with cdf[i - 1] <= u < cdf[i] of `n` >= 1 running sums, the last of which is 1. Remaps `u` in
/// [0, 1) to its relative position between the two, again in [0, 1). `u` is a double because each choice widens the
/// steps of a 24-bit number by the inverse of the probability. Branchless bisection.
inline int choose_index(const float* cdf, int n, double& u) {
  int first = 0;
  while (n > 1) {
    const int half = n / 2;
    first = cdf[first + half - 1] <= u ? first + half : first;
    n -= half;
  }
  const double below = first > 0 ? cdf[first - 1] : 0.0;
  u = std::clamp((u - below) / (cdf[first] - below), 0.0, 1 - 0x1p-53);
  return first;
}

/// Moves a 24-bit number to the middle of its step, so choices never remap it to 0, which is the antipode of a lobe.
inline double middle_of_step(float u) { return u + 0x1p-25; }

}  // namespace velour
