#include "math/sphere/random.h"

namespace velour {
namespace {

uint32_t reversed(uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Each output bit depends on the input bits at and below it: multiplying by even numbers only carries upward [LK11].
uint32_t carry_upwards(uint32_t x, uint32_t seed) {
  x += seed;
  for (const uint32_t factor : kOwenFactors) x ^= x * factor;
  return x;
}

/// Output bit i is the sum modulo 2 of the input bits j with (i & j) == i, which is where C(j, i) is odd (Lucas). Five
/// butterflies replace 32 direction numbers.
uint32_t pascal(uint32_t x) {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ (x >> 16);
}

}  // namespace

uint32_t owen_scramble(uint32_t bits, uint32_t seed) { return reversed(carry_upwards(reversed(bits), seed)); }

void sobol_points(uint64_t key, uint32_t first, std::span<Vec2> points) {
  const SobolSeeds seeds(key);
  const auto unit = [](uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
  for (uint32_t i = 0; i < points.size(); ++i) {
    const uint32_t index = owen_scramble(first + i, seeds.order);
    // owen_scramble(reversed(index)) without two reversals that cancel; likewise for y.
    points[i] = {unit(reversed(carry_upwards(index, seeds.x))), unit(reversed(carry_upwards(pascal(index), seeds.y)))};
  }
}

}  // namespace velour
