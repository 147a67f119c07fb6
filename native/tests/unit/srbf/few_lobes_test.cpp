#include "srbf/few_lobes.h"

#include <gtest/gtest.h>

#include "sphere/directions.h"
#include "sphere/random.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

/// A highlight of many widths about nearly one direction, as fits of glossy surfaces have it.
GaussianLobes highlight() {
  GaussianLobes lobes;
  RandomStream random(5, 0, 0);
  for (int k = 0; k < 12; ++k) {
    const float bandwidth = std::exp2(static_cast<float>(k));
    const Vec2 offset = (random.next2() - 0.5f) / std::sqrt(bandwidth);
    lobes.add({glm::normalize(Vec3(0.5f + offset.x, offset.y, 0.8f)), bandwidth, 1 + random.next()});
  }
  return lobes;
}

double energy(float amplitude, float bandwidth) {
  return static_cast<double>(amplitude) * kernel_integral(Kernel::gaussian, static_cast<double>(bandwidth));
}

double kernel_at(const Vec3& w, const Vec3& center, float bandwidth) {
  return kernel_value(Kernel::gaussian, static_cast<double>(bandwidth), one_minus_dot(Vec3d(w), Vec3d(center)));
}

/// Relative L2 by summing over directions.
double error_of(const std::vector<GaussianLobe>& few, const GaussianLobes& lobes) {
  double error_sq = 0, whole_sq = 0;
  for (const Vec3& w : sphere_fibonacci(200000)) {
    double whole = 0, sum = 0;
    for (size_t k = 0; k < lobes.size(); ++k) {
      whole += static_cast<double>(lobes.amplitude[k]) *
               kernel_at(w, {lobes.x[k], lobes.y[k], lobes.z[k]}, lobes.bandwidth[k]);
    }
    for (const GaussianLobe& lobe : few) {
      sum += static_cast<double>(lobe.amplitude) * kernel_at(w, lobe.center, lobe.bandwidth);
    }
    error_sq += (sum - whole) * (sum - whole);
    whole_sq += whole * whole;
  }
  return std::sqrt(error_sq / whole_sq);
}

TEST(FewLobes, AreTheFewestWithinTheTolerance) {
  const GaussianLobes lobes = highlight();
  for (const double tolerance : {0.1, 0.05, 0.02}) {
    const auto few = few_lobes(lobes, tolerance, 12);
    EXPECT_LE(error_of(few, lobes), 1.01 * tolerance);
    ASSERT_GT(few.size(), 1u);
    EXPECT_LT(few.size(), 12u);
    EXPECT_GT(error_of(few_lobes(lobes, 0, static_cast<int>(few.size()) - 1), lobes), 0.99 * tolerance);
  }
}

TEST(FewLobes, KeepTheEnergyAndComeWidestFirst) {
  const GaussianLobes lobes = highlight();
  double whole = 0;
  for (size_t k = 0; k < lobes.size(); ++k) whole += energy(lobes.amplitude[k], lobes.bandwidth[k]);
  for (const int most : {1, 3, 8}) {
    const auto few = few_lobes(lobes, 0, most);
    ASSERT_EQ(few.size(), static_cast<size_t>(most));
    double sum = 0;
    for (size_t k = 0; k < few.size(); ++k) {
      sum += energy(few[k].amplitude, few[k].bandwidth);
      EXPECT_GE(few[k].bandwidth, few[k == 0 ? 0 : k - 1].bandwidth);
    }
    EXPECT_NEAR(sum, whole, 1e-5 * whole);
  }
}

TEST(FewLobes, OfNoneAreNone) { EXPECT_TRUE(few_lobes({}, 0.3, 8).empty()); }

}  // namespace
}  // namespace velour
