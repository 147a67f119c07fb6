#include "math/srbf/multivariate_lobes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/memory.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/simd_targets.h"

namespace velour::multivariate_lobes_test {
namespace {

Vec3 random_vector(RandomStream& random, float longest) {
  return sample_cosine_hemisphere(random.next2()) * (longest * random.next());
}

/// Products of all kinds, the constant among them.
std::vector<MultivariateLobe> random_lobes(uint32_t count) {
  std::vector<MultivariateLobe> lobes(count);
  for (uint32_t k = 1; k < count; ++k) {
    RandomStream random(3, k, 0);
    if (k & 1) lobes[k].light = random_vector(random, 40);
    if (k & 2) lobes[k].view = random_vector(random, 20);
    if (k & 4) lobes[k].half = random_vector(random, 300);
    if (k & 8) lobes[k].phase = 20 * (random.next() - 0.3f);
  }
  return lobes;
}

LobeArguments random_arguments(uint64_t i) {
  RandomStream random(4, i, 0);
  const Vec3 wl = sample_cosine_hemisphere(random.next2());
  return LobeArguments({wl, sample_cosine_hemisphere(random.next2())});
}

double value_of(const MultivariateLobe& lobe, const LobeArguments& at) {
  double exponent =
      static_cast<double>(lobe.phase) * static_cast<double>(at.phase) - static_cast<double>(std::abs(lobe.phase));
  for (const auto& [vector, w] : {std::pair(lobe.light, at.wl), {lobe.view, at.wv}, {lobe.half, at.half}}) {
    exponent += glm::dot(Vec3d(vector), Vec3d(w)) - glm::length(Vec3d(vector));
  }
  return std::exp(exponent);
}

TEST(MultivariateLobes, AreTheProductsOfTheirArguments) {
  for (const uint32_t count : {1u, 15u, 16u, 17u, 70u}) {
    const auto lobes = random_lobes(count);
    const MultivariateLobes prepared(lobes);
    EXPECT_EQ(prepared.size(), count);
    EXPECT_EQ(prepared.padded() % MultivariateLobes::kPadding, 0u);
    AlignedArray<float> values(prepared.padded());
    test::on_every_simd_target([&] {
      for (uint64_t i = 0; i < 50; ++i) {
        const LobeArguments at = random_arguments(i);
        prepared.values(at, values.data());
        for (uint32_t k = 0; k < count; ++k) {
          // Exponents of up to 400 cancel at the peaks: their rounding is that of the value.
          const double expected = value_of(lobes[k], at);
          EXPECT_NEAR(static_cast<double>(values.data()[k]), expected, 2e-4 * expected + 1e-30) << k;
        }
      }
    });
  }
}

TEST(MultivariateLobes, PaddingIsZero) {
  const MultivariateLobes lobes(random_lobes(17));
  ASSERT_EQ(lobes.padded(), 32u);
  AlignedArray<float> values(32);
  test::on_every_simd_target([&] {
    lobes.values(random_arguments(1), values.data());
    for (uint32_t k = 17; k < 32; ++k) EXPECT_EQ(values.data()[k], 0.0f);
  });
}

TEST(MultivariateLobes, AreOneAtTheirPeak) {
  const Vec3 peak = glm::normalize(Vec3(0.3f, -0.5f, 0.7f));
  const MultivariateLobes lobes(std::vector<MultivariateLobe>{{}, {peak * 400.0f, peak * 20.0f, peak * 3.0f}});
  AlignedArray<float> values(lobes.padded());
  lobes.values(LobeArguments({peak, peak}), values.data());
  EXPECT_EQ(values.data()[0], 1.0f);
  EXPECT_NEAR(values.data()[1], 1.0f, 1e-4f);
}

/// There are two groups of lobes, the second in a rotated frame.
TEST(MultivariateLobes, SumsAreThoseOfCoefficientsTimesColorsTimesValues) {
  for (const uint32_t second : {0u, 5u, 30u}) {
    const MultivariateLobes first(random_lobes(40)), other(random_lobes(second));
    const uint32_t padded = first.padded() + other.padded();
    AlignedArray<float> coefficient(padded), color(size_t{3} * padded), values(padded);
    RandomStream random(6, 0, 0);
    const Mat3 turn(Vec3(0.6f, 0, 0.8f), Vec3(0, 1, 0), Vec3(-0.8f, 0, 0.6f));
    // What stands behind the lobes is multiplied by nothing.
    for (uint32_t i = 0; i < padded; ++i) coefficient.data()[i] = random.next() - 0.5f;
    for (uint32_t i = 0; i < 3 * padded; ++i) color.data()[i] = random.next() - 0.5f;
    test::on_every_simd_target([&] {
      for (uint64_t i = 0; i < 20; ++i) {
        const LobeArguments at = random_arguments(i);
        first.values(at, values.data());
        other.values(at.turned(turn), values.data() + first.padded());
        const Vec3 sums = lobe_sums({first, other, color.data()}, {at.wl, at.wv}, turn, coefficient.data());
        for (uint32_t c = 0; c < 3; ++c) {
          double expected = 0;
          for (uint32_t k = 0; k < padded; ++k) {
            const float weight = color.data()[k / 16 * 48 + 16 * c + k % 16];
            expected += static_cast<double>(values.data()[k]) * static_cast<double>(coefficient.data()[k]) *
                        static_cast<double>(weight);
          }
          EXPECT_NEAR(static_cast<double>(sums[static_cast<int>(c)]), expected, 1e-5);
        }
      }
    });
  }
}

TEST(MultivariateLobes, HalfVectorsOfOppositeDirectionsAreTheNormal) {
  const Vec3 w = glm::normalize(Vec3(1, 2, 0.5f));
  EXPECT_EQ(half_vector({w, -w}), Vec3(0, 0, 1));
  EXPECT_NEAR(glm::length(half_vector({w, {0, 0, 1}})), 1.0f, 1e-6f);
}

TEST(MultivariateLobes, ArgumentsTurnTogether) {
  const LobeArguments at = random_arguments(3);
  const Mat3 turn(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));  // by 90 degrees about z
  const LobeArguments turned = at.turned(turn);
  EXPECT_EQ(turned.wl, Vec3(-at.wl.y, at.wl.x, at.wl.z));
  EXPECT_EQ(turned.half, Vec3(-at.half.y, at.half.x, at.half.z));
  EXPECT_NEAR(glm::distance(turned.half, half_vector({turned.wl, turned.wv})), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace velour::multivariate_lobes_test
