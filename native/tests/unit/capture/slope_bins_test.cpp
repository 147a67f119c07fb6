#include "capture/goniometer/bins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/random.h"

namespace velour::slope_bins_test {
namespace {

/// A normally distributed slope of roughness alpha along each axis.
Vec2 random_slope(uint64_t i, const Vec2& alpha) {
  RandomStream random(1, 2, i);
  const float radius = std::sqrt(-std::log(1.0f - random.next())), angle = 2 * kPi * random.next();
  return alpha * Vec2(radius * std::cos(angle), radius * std::sin(angle));
}

double gaussian_density(const Vec2& slope, const Vec2& alpha) {
  const Vec2 s = slope / alpha;
  return std::exp(-static_cast<double>(glm::dot(s, s))) / (kPiD * static_cast<double>(alpha.x * alpha.y));
}

class SlopeBinsOf : public testing::TestWithParam<float> {};

TEST_P(SlopeBinsOf, RecoverADensity) {
  const Vec2 alpha(0.2f, 0.2f / GetParam());
  const SlopeBins bins(static_cast<double>(alpha.x), static_cast<double>(alpha.y));
  std::vector<double> counts(bins.size(), 0.0);
  constexpr uint64_t facets = 2'000'000;
  for (uint64_t i = 0; i < facets; ++i) bins.deposit(random_slope(i, alpha), counts);
  const std::vector<double> density = bins.density(counts, static_cast<double>(facets));
  for (const float r : {0.0f, 0.05f, 0.3f, 1.0f, 1.6f, 2.2f}) {
    for (const float psi : {0.0f, 0.5f, 1.2f, 1.57f}) {
      const Vec2 slope = alpha * r * Vec2(std::cos(psi), std::sin(psi));
      // 2e6 facets leave 1 to 3 % of noise in a bin; interpolation adds 1 % where the density curves.
      EXPECT_NEAR(bins.look_up(slope, density) / gaussian_density(slope, alpha), 1, r < 2 ? 0.06 : 0.1)
          << r << ' ' << psi;
      EXPECT_EQ(bins.look_up(slope, density), bins.look_up({-slope.x, slope.y}, density));
    }
  }
  EXPECT_EQ(bins.look_up(alpha * 7.0f, density), 0.0);  // nothing beyond the last bin
}

INSTANTIATE_TEST_SUITE_P(Anisotropy, SlopeBinsOf, testing::Values(1.0f, 5.0f));

TEST(SlopeBins, AFewFacetsAreSpreadOverNeighbors) {
  const SlopeBins bins(0.2, 0.2);
  std::vector<double> counts(bins.size(), 0.0);
  for (int i = 0; i < 10; ++i) bins.deposit({0.6f, 0.0f}, counts);
  const std::vector<double> density = bins.density(counts, 10.0);
  EXPECT_GT(bins.look_up({0.57f, 0.0f}, density), 0.0);
  EXPECT_EQ(bins.look_up({0.4f, 0.0f}, density), 0.0);
}

}  // namespace
}  // namespace velour::slope_bins_test
