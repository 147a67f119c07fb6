#include "math/sphere/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace velour::sobol_test {
namespace {

/// Whether every elementary interval of area 1 / n holds one of the n = 2^m points.
bool is_net(std::span<const Vec2> points) {
  const int n = static_cast<int>(points.size()), m = std::countr_zero(points.size());
  for (int a = 0; a <= m; ++a) {
    const int columns = 1 << a, rows = n / columns;
    std::vector<int> held(static_cast<size_t>(n));
    for (const Vec2& p : points) {
      const int x = static_cast<int>(p.x * static_cast<float>(columns));
      const int y = static_cast<int>(p.y * static_cast<float>(rows));
      if (held[static_cast<size_t>(y * columns + x)]++ > 0) return false;
    }
  }
  return true;
}

std::vector<Vec2> sequence(uint64_t key, uint32_t first, size_t count) {
  std::vector<Vec2> points(count);
  sobol_points(key, first, points);
  return points;
}

TEST(Sobol, FollowsTheRecurrenceOfItsDirectionNumbers) {
  // m_j = 2 m_(j-1) xor m_(j-1): primitive polynomial x + 1 [Sob67].
  std::array<uint32_t, 32> direction{};
  uint32_t m = 1;
  for (uint32_t j = 0; j < 32; ++j, m = (m << 1) ^ m) direction[j] = m << (31 - j);
  const uint64_t key = 3;
  const SobolSeeds seeds(key);
  const auto scrambled = [](uint32_t bits, uint32_t seed) {
    return static_cast<float>(owen_scramble(bits, seed) >> 8) * 0x1p-24f;
  };
  for (uint32_t place : {0u, 1u, 2u, 3u, 4u, 5u, 77u, 12345u, 0x87654321u, 0xffffffffu}) {
    const uint32_t index = owen_scramble(place, seeds.order);
    uint32_t second = 0, first = 0;
    for (uint32_t j = 0; j < 32; ++j) {
      if ((index >> j & 1u) == 0) continue;
      second ^= direction[j];
      first |= 1u << (31 - j);
    }
    EXPECT_EQ(sequence(key, place, 1)[0], Vec2(scrambled(first, seeds.x), scrambled(second, seeds.y))) << place;
  }
}

TEST(Sobol, AlignedRunsAreNets) {
  for (uint64_t key : {1ull, 2ull, 99ull, 0xdeadbeefcafef00dull}) {
    for (uint32_t count : {2u, 4u, 16u, 64u, 512u}) {
      for (uint32_t run : {0u, 1u, 5u, 1000u}) EXPECT_TRUE(is_net(sequence(key, run * count, count))) << count;
    }
  }
}

TEST(Sobol, NegativeControlIndependentAndMisalignedPointsAreNoNets) {
  RandomStream random(1, 2, 3);
  std::vector<Vec2> points(64);
  for (Vec2& p : points) p = random.next2();
  EXPECT_FALSE(is_net(points));
  EXPECT_FALSE(is_net(sequence(1, 7, 64)));
}

TEST(Sobol, PointsLieBelowOneAndDependOnTheirPlaceAlone) {
  const auto whole = sequence(5, 100, 50), part = sequence(5, 120, 10);
  for (size_t i = 0; i < 10; ++i) EXPECT_EQ(whole[20 + i], part[i]);
  for (uint32_t start : {0u, 0xfffffff0u}) {
    for (const Vec2& p : sequence(9, start, 16)) {
      EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    }
  }
}

TEST(OwenScramble, KeepsWhatSharesItsUpperBitsTogether) {
  RandomStream random(4, 4, 4);
  for (int trial = 0; trial < 200; ++trial) {
    const auto a = static_cast<uint32_t>(random.next_bits()), seed = static_cast<uint32_t>(random.next_bits());
    const uint32_t bit = static_cast<uint32_t>(random.next_bits()) % 32;
    const uint32_t b = a ^ (1u << bit);
    // First differing bit of the images is the first differing bit of the arguments.
    EXPECT_EQ(std::countl_zero(owen_scramble(a, seed) ^ owen_scramble(b, seed)), 31 - static_cast<int>(bit));
  }
}

TEST(OwenScramble, EveryPointIsUniformOverKeys) {
  // Chi-square over 16 x 16 cells, 255 degrees of freedom: 330 is the 99.9 % quantile.
  for (uint32_t index : {0u, 1u, 2u, 31u}) {
    std::array<int, 256> cells{};
    constexpr int kKeys = 65536;
    for (uint64_t key = 0; key < kKeys; ++key) {
      const Vec2 p = sequence(mix64(key + 1), index, 1)[0];
      ++cells[static_cast<size_t>(p.x * 16) * 16 + static_cast<size_t>(p.y * 16)];
    }
    double chi_sq = 0;
    for (int n : cells) chi_sq += (n - kKeys / 256.0) * (n - kKeys / 256.0) / (kKeys / 256.0);
    EXPECT_LT(chi_sq, 330) << index;
  }
}

TEST(OwenScramble, SequencesOfDifferentKeysDoNotCorrelate) {
  // Means of a smooth function over the sequences of neighboring keys.
  constexpr int kKeys = 20000;
  const auto mean = [](uint64_t key) {
    double sum = 0;
    for (const Vec2& p : sequence(key, 0, 4)) sum += static_cast<double>(p.x * p.y);
    return sum / 4 - 0.25;
  };
  for (bool control : {false, true}) {
    double product = 0, square = 0;
    for (uint64_t k = 0; k < kKeys; ++k) {
      const double a = mean(mix64(k)), b = control ? a : mean(mix64(k + 1));
      product += a * b;
      square += a * a;
    }
    const double correlation = product / square;
    if (control) {
      EXPECT_NEAR(correlation, 1, 1e-9);
    } else {
      EXPECT_LT(std::abs(correlation), 4 / std::sqrt(kKeys));
    }
  }
}

TEST(OwenScramble, VarianceFallsFasterThanWithIndependentNumbers) {
  // A smooth integrand: variance n^-3 in theory [Owe97], n^-1 with independent numbers.
  const auto variance = [](size_t count) {
    double sum_sq = 0;
    for (uint64_t key = 0; key < 400; ++key) {
      double sum = 0;
      for (const Vec2& p : sequence(mix64(key + 7), 0, count)) {
        sum += std::exp(static_cast<double>(p.x)) * std::cos(static_cast<double>(p.y));
      }
      const double error = sum / static_cast<double>(count) - (std::exp(1.0) - 1) * std::sin(1.0);
      sum_sq += error * error;
    }
    return sum_sq / 400;
  };
  EXPECT_LT(variance(256) / variance(16), 1.0 / (16 * 16));
}

}  // namespace
}  // namespace velour::sobol_test
