// Products of lobes in float SIMD against the scalar reference in double.
#include "srbf/lobe_products.h"

#include <gtest/gtest.h>

#include "sphere/directions.h"
#include "srbf/simd_target.h"

namespace velour {
namespace {

GaussianLobes sky() {
  GaussianLobes lobes;
  const auto centers = sphere_fibonacci(47);
  for (size_t k = 0; k < centers.size(); ++k) {
    lobes.add({centers[k], 0.05f * std::pow(2e7f, static_cast<float>(k) / 46), 1 + static_cast<float>(k)});
  }
  lobes.add({{0, 0, 1}, 1, 0});
  return lobes;
}

LobeProducts multiplied(const GaussianLobe& lobe, const GaussianLobes& others, const Vec3* normal = nullptr) {
  LobeProducts products;
  multiply_lobes(lobe, others, 0, static_cast<int>(others.size()), normal, products);
  return products;
}

TEST(LobeProducts, MatchTheScalarReferenceOnEveryTarget) {
  const GaussianLobes others = sky();
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
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
        EXPECT_NEAR(products.bandwidth[k], p.bandwidth, 1e-5 * p.bandwidth + 2e-4);
        if (p.bandwidth < 1e-2) continue;
        EXPECT_LT(glm::distance(Vec3d(products.x[k], products.y[k], products.z[k]), p.center), 2e-4) << k;
      }
    }
  }
  select_simd_target("auto");
}

TEST(LobeProducts, WhatLiesBelowTheHorizonWeighsNothing) {
  const Vec3 normal(0, 0, 1);
  GaussianLobes others;
  for (const Vec3& c : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1)}) others.add({c, 100, 1});
  while (others.size() < 16) others.add({{0, 0, 1}, 1, 0});
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
  EXPECT_FALSE(keep_products(multiplied({{0, 0, 1}, 20, 0}, sky()), 0, none));
  EXPECT_FALSE(keep_products({}, 0, none));
}

}  // namespace
}  // namespace velour
