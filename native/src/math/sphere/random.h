// Random numbers as pure functions of their indices, and Sobol's sequence.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include "math/sphere/vec.h"

namespace velour {

// Counter-based random numbers: every number is a pure function of (seed, stream, sample, dimension), so results do not
// depend on threads or on the order of tiles.

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

// Sobol's sequence in two dimensions, Owen scrambled by hashing.

/// Owen's nested uniform scrambling [Owe95] of the fraction `bits` / 2^32: every bit is flipped or not by a hash of the
/// bits above it ([LK11] with the constants of [Bur20]). For fixed `bits` it is a bijection of `seed`, so a scrambled
/// point is exactly uniform over the seeds.
uint32_t owen_scramble(uint32_t bits, uint32_t seed);

/// Multipliers of the hash [Bur20]; even, so that carries only propagate upward [LK11].
inline constexpr uint32_t kOwenFactors[] = {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u};

/// Seeds that scramble the sequence of a key: its order and both coordinates.
struct SobolSeeds {
  uint32_t order, x, y;
  explicit SobolSeeds(uint64_t key) : order(upper(key)), x(upper(mix64(key + 1))), y(upper(mix64(key + 2))) {}

 private:
  static uint32_t upper(uint64_t bits) { return static_cast<uint32_t>(bits >> 32); }
};

/// Points `first`, `first` + 1, ... of Sobol's sequence [Sob67], in [0, 1)^2. The first coordinate is the radical
/// inverse of the index; the second has the generator matrix C(j, i) mod 2 (primitive polynomial x + 1), so no table is
/// needed. Every aligned run of 2^m points is a (0, m, 2)-net: one point in every elementary interval of area 2^-m.
/// The points are shuffled, which keeps aligned runs of 2^m together [Bur20 section 5], and each coordinate is
/// scrambled, all seeded by `key`. Sequences of different keys are independent, so dimensions can be padded in pairs.
void sobol_points(uint64_t key, uint32_t first, std::span<Vec2> points);

}  // namespace velour
