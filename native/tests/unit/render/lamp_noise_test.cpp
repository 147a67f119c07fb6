// What directions of the surface that find a lamp cost beside those that are drawn to it.
#include <gtest/gtest.h>

#include "support/test_scene.h"

namespace velour::lamp_noise_test {
namespace {

/// A matte floor under one lamp without anything between, a direction a camera ray.
Scene floor_under(const Light& lamp) {
  Scene scene;
  const uint32_t matte = scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(scene.add_mesh(test::square(4)), {}, {matte});
  scene.add_light(lamp);
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return scene;
}

/// Mean over the pixels of the variance over seeds, of the picture's mean square.
double noise(const Scene& scene, Strategy strategy, int directions) {
  constexpr int kSeeds = 8;
  RenderOptions options = test::small_options(strategy, directions);
  options.split = 1;
  std::vector<double> sum, squares;
  for (int seed = 0; seed < kSeeds; ++seed) {
    options.seed = static_cast<uint64_t>(seed);
    const auto pixels = test::rendered(scene, options);
    sum.resize(pixels.size() / 4);
    squares.resize(sum.size());
    for (size_t i = 0; i < sum.size(); ++i) {
      const auto x = static_cast<double>(pixels[4 * i]);
      sum[i] += x;
      squares[i] += x * x;
    }
  }
  double variance = 0, level = 0;
  for (size_t i = 0; i < sum.size(); ++i) {
    variance += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
    level += squares[i] / kSeeds;
  }
  return variance / level;
}

TEST(LampNoise, OfMixedStrategiesIsLittleInTheOpen) {
  Light sun;
  sun.angle = 0.2f;
  Light ball;
  ball.type = Light::Type::point;
  ball.size = {1, 0};
  ball.color = Rgb(100);
  ball.light_to_world = test::shift({0.3f, -0.2f, 3});
  for (const Light& lamp : {sun, ball}) {
    const Scene scene = floor_under(lamp);
    EXPECT_LT(noise(scene, Strategy::light, 64), 5e-6);
    EXPECT_LT(noise(scene, Strategy::mis, 64), 5e-5);     // balance: 2e-4 and 5e-4
    EXPECT_GT(noise(scene, Strategy::cosine, 64), 0.02);  // the control
  }
}

}  // namespace
}  // namespace velour::lamp_noise_test
