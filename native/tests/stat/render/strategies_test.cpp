// Every strategy converges to the same picture.
#include <gtest/gtest.h>

#include "material/principled_material.h"
#include "sphere/random.h"
#include "support/chi_square.h"
#include "support/statistics.h"
#include "support/test_scene.h"

namespace velour {
namespace {

/// A glossy sphere over a rough plane, occluding each other, under an uneven sky and every kind of lamp.
Scene gallery(float brighter = 1) {
  Scene scene;
  scene.add_mesh(test::square(4));
  scene.add_mesh(test::sphere(24));
  scene.add_material({std::make_shared<test::Lambert>(0.7f), Rgb(0.0f), false});
  scene.add_material({make_principled_material({{0.8f, 0.5f, 0.3f}, 1.0f, 0.5f, 0.5f}), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.add_instance(1, test::shift({0, 0, 1.1f}), {1});
  std::vector<float> pixels(3 * 16 * 8);
  RandomStream random(3, 3, 3);
  for (float& p : pixels) p = std::pow(random.next(), 4.0f) * 2;
  scene.set_environment(Environment::image({16, 8, 3, pixels}, brighter, Mat3(1.0f)));
  Light sun;
  sun.angle = 0.5f;
  sun.light_to_world.m[2] = 0.6f;
  sun.light_to_world.m[10] = 0.8f;
  scene.add_light(sun);
  sun.angle = 0;
  sun.light_to_world.m[2] = -0.6f;
  sun.color = Rgb(0.5f);
  scene.add_light(sun);
  Light lamp;
  lamp.light_to_world = test::shift({1.5f, 1.5f, 3});
  for (Light::Type type : {Light::Type::rectangle, Light::Type::disk, Light::Type::point}) {
    lamp.type = type;
    lamp.size = {1, 1};
    lamp.color = Rgb(15.0f);
    lamp.light_to_world.m[3] -= 1.2f;
    scene.add_light(lamp);
  }
  scene.set_camera(Camera::look_at({0, -6, 4}, {0, 0, 0.8f}, {0, 0, 1}, 0.5f, 1));
  scene.commit(2);
  return scene;
}

constexpr int kRegions = 4;
using Regions = std::array<test::RunningMean, kRegions>;

/// Means over the four quarters of the picture, by independent renders.
Regions measure(const Scene& scene, Strategy strategy, int bounces) {
  Regions regions;
  RenderOptions options = test::small_options(strategy, 128);
  options.bounces = bounces;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    options.seed = seed * 6 + static_cast<uint64_t>(strategy);
    const auto pixels = test::rendered(scene, options);
    std::array<double, kRegions> sums{};
    for (size_t i = 0; i < 64; ++i) sums[2 * (i / 32) + i % 8 / 4] += pixels[4 * i + 1] / 16;
    for (size_t r = 0; r < kRegions; ++r) regions[r].add(sums[r]);
  }
  return regions;
}

double least_p(const Regions& a, const Regions& b) {
  double least = 1;
  for (size_t r = 0; r < kRegions; ++r) {
    least = std::min(least, test::z_test(a[r].mean(), a[r].standard_error(), b[r].mean(), b[r].standard_error()));
  }
  return least;
}

class Strategies : public ::testing::TestWithParam<int> {};

TEST_P(Strategies, AgreeWithinTheirErrors) {
  const Scene scene = gallery();
  const Regions reference = measure(scene, Strategy::mis, GetParam());
  const double level = test::sidak_level(0.01, 6 * kRegions);
  for (Strategy s :
       {Strategy::uniform, Strategy::cosine, Strategy::table, Strategy::srbf, Strategy::light, Strategy::product}) {
    EXPECT_GT(least_p(measure(scene, s, GetParam()), reference), level) << static_cast<int>(s);
  }
}

TEST_P(Strategies, NegativeControlASkyTenPercentBrighterIsSeen) {
  const Regions a = measure(gallery(1.1f), Strategy::mis, GetParam());
  const Regions b = measure(gallery(), Strategy::mis, GetParam());
  EXPECT_LT(least_p(a, b), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(DirectAndIndirect, Strategies, ::testing::Values(0, 2));

TEST(Mis, OddSplitsAreUnbiased) {
  const Scene scene = gallery();
  for (int split : {1, 3}) {
    test::RunningMean odd, even;
    for (uint64_t seed = 0; seed < 40; ++seed) {
      RenderOptions options = test::small_options(Strategy::mis, 63);
      options.split = split;
      options.seed = seed;
      odd.add(test::mean_of(test::rendered(scene, options)));
      options.split = 8;
      options.seed = seed + 1000;
      even.add(test::mean_of(test::rendered(scene, options)));
    }
    EXPECT_GT(test::z_test(odd.mean(), odd.standard_error(), even.mean(), even.standard_error()), 0.005) << split;
  }
}

TEST(Mis, NoiseEstimateIsHonest) {
  // The spread of independent renders of one pixel against what each of them claims.
  const Scene scene = gallery();
  RenderOptions options = test::small_options(Strategy::mis, 128);
  std::vector<test::RunningMean> pixels(64);
  test::RunningMean claimed;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    options.seed = seed;
    RenderReport report;
    const auto picture = test::rendered(scene, options, "Combined", &report);
    claimed.add(report.noise);
    for (size_t i = 0; i < 64; ++i) {
      pixels[i].add(static_cast<double>(luminance({picture[4 * i], picture[4 * i + 1], picture[4 * i + 2]})));
    }
  }
  double variance = 0, mean = 0;
  for (const auto& p : pixels) {
    variance += p.variance() / 64;
    mean += p.mean() / 64;
  }
  EXPECT_NEAR(claimed.mean() / (std::sqrt(variance) / mean), 1, 0.1);
}

}  // namespace
}  // namespace velour
