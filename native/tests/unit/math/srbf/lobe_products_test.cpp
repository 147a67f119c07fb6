// Products of lobes in float SIMD against the scalar reference in double.
#include "math/srbf/lobe_products.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "support/simd_targets.h"

namespace velour::lobe_products_test {
namespace {

GaussianLobes sky() {
  GaussianLobes lobes;
  const auto centers = sphere_fibonacci(47);
  for (size_t k = 0; k < centers.size(); ++k) {
    lobes.add({centers[k], 0.05f * std::pow(2e7f, static_cast<float>(k) / 46), 1 + static_cast<float>(k)});
  }
  return lobes;
}

LobeProducts multiplied(const GaussianLobe& lobe, const GaussianLobes& others, const Vec3* normal = nullptr) {
  LobeProducts products;
  multiply_lobes(lobe, in_blocks(others), normal, products);
  return products;
}

TEST(LobeProducts, MatchTheScalarReferenceOnEveryTarget) {
  const GaussianLobes others = sky();
  test::on_every_simd_target([&] {
    for (const float bandwidth : {0.1f, 5.0f, 300.0f, 1e5f}) {
      const GaussianLobe lobe{glm::normalize(Vec3(0.3f, -0.5f, 0.8f)), bandwidth, 0.7f};
      const LobeProducts products = multiplied(lobe, others);
      ASSERT_EQ(products.count, 48);
      for (size_t k = 0; k < others.size(); ++k) {
        const Vec3d center(others.x[k], others.y[k], others.z[k]);
        const GaussianProduct p = gaussian_product(Vec3d(lobe.center), static_cast<double>(bandwidth), center,
                                                   static_cast<double>(others.bandwidth[k]));
        const double mass =
            0.7 * static_cast<double>(others.amplitude[k]) * p.scale * kernel_integral(Kernel::gaussian, p.bandwidth);
        const double exponent = -std::log(std::max(p.scale, 1e-40));
        EXPECT_NEAR(products.mass[k], mass, mass * 1e-5 * (1 + exponent) + 1e-30) << bandwidth << ' ' << k;
        if (products.mass[k] == 0) continue;
        EXPECT_NEAR(products.bandwidth[k], p.bandwidth, 1e-5 * p.bandwidth + 2e-4);
        if (p.bandwidth < 1e-2) continue;
        EXPECT_LT(glm::distance(Vec3d(products.x[k], products.y[k], products.z[k]), p.center), 2e-4) << k;
      }
    }
  });
}

// The estimate of what lies above a horizon, as the header states it: logistic in 1.702 c sqrt(R).
TEST(LobeProducts, ShareAboveTheHorizonMatchesTheScalarReferenceOnEveryTarget) {
  const GaussianLobes others = sky();
  const Vec3 normal = glm::normalize(Vec3(-0.4f, 0.7f, 0.2f));
  test::on_every_simd_target([&] {
    for (const float bandwidth : {0.1f, 5.0f, 300.0f, 1e5f}) {
      const GaussianLobe lobe{glm::normalize(Vec3(0.3f, -0.5f, 0.8f)), bandwidth, 0.7f};
      const LobeProducts free = multiplied(lobe, others), above = multiplied(lobe, others, &normal);
      for (size_t k = 0; k < others.size(); ++k) {
        if (free.mass[k] == 0) continue;
        const double c = glm::dot(Vec3d(normal), Vec3d(free.x[k], free.y[k], free.z[k]));
        const double x = 1.702 * c * std::sqrt(static_cast<double>(free.bandwidth[k]));
        const double expected = static_cast<double>(free.mass[k]) / (1 + std::exp(-x));
        // A float's rounding of c, in the exponent.
        EXPECT_NEAR(above.mass[k], expected, expected * (1e-5 + 1e-6 * std::sqrt(free.bandwidth[k])) + 1e-30)
            << bandwidth << ' ' << k;
      }
    }
  });
}

/// A density that holds just the products of at least `bound` of the mass, in their order and proportion.
TEST(LobeProducts, ChoiceMatchesTheScalarReferenceOnEveryTarget) {
  const LobeProducts products = multiplied({{0, 0, 1}, 20, 1}, sky());
  double total = 0;
  for (int i = 0; i < products.count; ++i) total += static_cast<double>(products.mass[i]);
  test::on_every_simd_target([&] {
    for (const float bound : {0.3f, 0.1f, 0.02f, 0.005f}) {
      LobeMixture density;
      ASSERT_TRUE(keep_products(products, bound, density));
      std::vector<size_t> chosen;
      double sum = 0, below = 0;
      for (size_t i = 0; i < static_cast<size_t>(products.count); ++i) {
        if (static_cast<double>(products.mass[i]) < static_cast<double>(bound) * total) continue;
        chosen.push_back(i);
        sum += static_cast<double>(products.mass[i]);
      }
      if (chosen.empty()) continue;  // nothing above the bound: the best one stands for all
      ASSERT_EQ(density.count, static_cast<int>(chosen.size())) << bound;
      for (size_t k = 0; k < chosen.size(); ++k) {
        const size_t i = chosen[k];
        const double share = static_cast<double>(products.mass[i]) / sum;
        const double peak = share / kernel_integral(Kernel::gaussian, static_cast<double>(products.bandwidth[i]));
        EXPECT_EQ(density.x[k], products.x[i]);
        EXPECT_EQ(density.bandwidth[k], products.bandwidth[i]);
        EXPECT_NEAR(density.density[k], peak, 1e-5 * peak);
        EXPECT_NEAR(density.cdf[k], below += share, 1e-6);
      }
    }
  });
}

// la a + lb b has no direction there; what is sampled must still be one.
TEST(LobeProducts, CentersOfBroadOpposedLobesAreUnit) {
  GaussianLobes others;
  for (const float bandwidth : {0.0f, 1e-4f, 1e-2f, 0.3f}) {
    for (const float angle : {0.0f, 1e-3f, 1.6f, 3.0f, 3.1415926f}) others.add({direction(angle, 0.3f), bandwidth, 1});
  }
  test::on_every_simd_target([&] {
    for (const float bandwidth : {0.0f, 1e-4f, 1e-2f, 0.3f}) {
      const LobeProducts products = multiplied({{0, 0, 1}, bandwidth, 1}, others);
      for (int i = 0; i < products.count; ++i) {
        const Vec3 center(products.x[i], products.y[i], products.z[i]);
        EXPECT_NEAR(glm::length(center), 1, 3e-5f) << bandwidth << ' ' << i;
        EXPECT_GE(products.bandwidth[i], 0);
      }
    }
  });
}

TEST(LobeProducts, WhatLiesBelowTheHorizonWeighsNothing) {
  const Vec3 normal(0, 0, 1);
  GaussianLobes others;
  for (const Vec3& c : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1)}) others.add({c, 100, 1});
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 center(others.x[k], others.y[k], others.z[k]);
    const LobeProducts free = multiplied({center, 100, 1}, others),
                       above = multiplied({center, 100, 1}, others, &normal);
    const float expected[] = {1, 0.5f, 0};
    EXPECT_NEAR(above.mass[k] / free.mass[k], expected[k], 1e-4f);
  }
}

TEST(LobeProducts, KeepsTheBestAndRefusesTheBlack) {
  const LobeProducts products = multiplied({{0, 0, 1}, 20, 1}, sky());
  LobeMixture all, best;
  ASSERT_TRUE(keep_products(products, 0, all));
  ASSERT_TRUE(keep_products(products, 0.05f, best));
  EXPECT_GT(all.count, best.count);
  EXPECT_GT(best.count, 0);
  EXPECT_EQ(best.cdf[best.count - 1], 1);
  LobeMixture none;
  for (const float amplitude : {0.0f, 1e-42f}) {
    EXPECT_FALSE(keep_products(multiplied({{0, 0, 1}, 20, amplitude}, sky()), 0, none));
  }
  EXPECT_FALSE(keep_products({}, 0, none));
}

}  // namespace
}  // namespace velour::lobe_products_test
