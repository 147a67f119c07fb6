// Sobol's sequence in two dimensions, Owen scrambled by hashing.
#pragma once

#include <cstdint>
#include <span>

#include "math/sphere/random.h"
#include "math/sphere/vec.h"

namespace velour {

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
