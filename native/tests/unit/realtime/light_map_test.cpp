#include "realtime/light_map.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/srbf/kernel.h"
#include "support/sky_lobes.h"
#include "support/table_shader.h"

namespace velour::light_map_test {
namespace {

EnvironmentMixture sky_with_sun() {
  return test::sky_of({{{0, 0, 1}, 0, Rgb(0.1f, 0.2f, 0.3f)},
                       {{0.2f, 0.1f, 1}, 1.5f, Rgb(0.5f, 0.6f, 0.9f)},
                       {{1, -0.5f, 0.8f}, 3000, Rgb(900, 800, 600)},
                       {{-1, 0.3f, 0.2f}, 40, Rgb(3, 1, 0.5f)},
                       {{-0.2f, -0.9f, -0.4f}, 12, Rgb(0.2f, 0.7f, 0.1f)}});
}

/// The mean over a Gaussian density, by the closed form in double.
Vec3d mean_of(const EnvironmentMixture& sky, const Vec3& w, double bandwidth) {
  Vec3d sum(0.0);
  for (size_t k = 0; k < sky.size(); ++k) {
    sum += Vec3d(sky.coefficient[k].r, sky.coefficient[k].g, sky.coefficient[k].b) *
           (kernel_convolution(Kernel::gaussian, Vec3d(w), bandwidth, Vec3d(sky.center[k]),
                               std::max(static_cast<double>(sky.bandwidth[k]), 1e-9)) /
            kernel_integral(Kernel::gaussian, bandwidth));
  }
  return sum;
}

/// Irradiance over pi, by the sum over evenly spread light directions.
Vec3d received(const EnvironmentMixture& sky, const Vec3& normal) {
  Vec3d sum(0.0);
  const auto lights = sphere_fibonacci(200000);
  for (const Vec3& w : lights) {
    const double cosine = std::max(static_cast<double>(glm::dot(w, normal)), 0.0);
    if (cosine == 0) continue;
    for (size_t k = 0; k < sky.size(); ++k) {
      const double kernel = kernel_value(Kernel::gaussian, static_cast<double>(sky.bandwidth[k]),
                                         one_minus_dot(Vec3d(w), Vec3d(sky.center[k])));
      sum += cosine * kernel * Vec3d(sky.coefficient[k].r, sky.coefficient[k].g, sky.coefficient[k].b);
    }
  }
  return sum * (4 / static_cast<double>(lights.size()));
}

class LightMap : public ::testing::Test {
 protected:
  static TablePixels& map() {
    static TablePixels made = [] {
      Progress progress;
      return light_map(sky_with_sun(), Environment::constant(Rgb(0.25f, 0.5f, 1)), 0, progress);
    }();
    return made;
  }
};

TEST_F(LightMap, LooksUpProductIntegrals) {
  const EnvironmentMixture sky = sky_with_sun();
  for (const double bandwidth : {1.0, 1.4, 5.0, 33.0, 260.0, 1448.0, 8192.0}) {
    double error = 0, peak = 0;
    auto places = sphere_fibonacci(997);
    for (const Vec3& lamp : sky.center) {  // and close to the lamps
      for (const float turn : {0.0f, 0.3f, 1.0f}) {
        places.push_back(
            glm::normalize(lamp + turn / std::sqrt(static_cast<float>(bandwidth)) * Vec3(0.3f, 0.5f, -0.7f)));
      }
    }
    for (const Vec3& w : places) {
      const Vec3d exact = mean_of(sky, w, bandwidth);
      const Vec3d found(test::mean_light(map(), LightLevels::of(static_cast<float>(bandwidth)), w));
      error = std::max(error, glm::length(found - exact));
      peak = std::max(peak, glm::length(exact));
    }
    EXPECT_LT(error, 0.03 * peak) << "bandwidth " << bandwidth;
  }
}

TEST_F(LightMap, KnowsWhatAReceiverGets) {
  const EnvironmentMixture sky = sky_with_sun();
  for (const Vec3& normal : sphere_fibonacci(23)) {
    const Vec3d exact = received(sky, normal);
    const Vec3d found(test::mean_light(map(), LightLevels::kCosine, normal));
    EXPECT_LT(glm::length(found - exact), 0.01 * glm::length(exact));
  }
}

TEST_F(LightMap, HoldsTheSkyItself) {
  for (const Vec3& w : sphere_fibonacci(50)) {
    const Vec3 found = test::mean_light(map(), LightLevels::kSky, w);
    EXPECT_NEAR(found.x, 0.25f, 1e-6f);
    EXPECT_NEAR(found.z, 1, 1e-6f);
  }
}

TEST(LightMapOfNothing, IsBlack) {
  Progress progress;
  const TablePixels map = light_map({}, Environment(), 1, progress);
  for (const float level : {0.0f, 1.0f, 7.5f, 28.0f}) {
    EXPECT_EQ(test::mean_light(map, level, Vec3(0, 0, 1)), Vec3(0.0f));
  }
}

TEST(LightLevelsOf, BandwidthsAreLogarithms) {
  EXPECT_FLOAT_EQ(LightLevels::of(1), 1);
  EXPECT_FLOAT_EQ(LightLevels::of(0.1f), 1);
  EXPECT_FLOAT_EQ(LightLevels::of(64), 13);
  EXPECT_FLOAT_EQ(LightLevels::of(1e7f), 27);
  EXPECT_FLOAT_EQ(LightLevels::bandwidth(27), 8192);
}

}  // namespace
}  // namespace velour::light_map_test
