// Pictures of uncompressed BTFs: all strategies have the same expectation, and no light is lost or made.
#include <gtest/gtest.h>

#include "support/strategy_agreement.h"
#include "support/striped_btf.h"

namespace velour::measured_btf_test {
namespace {

using Shared = std::shared_ptr<const Material>;

Shared striped_material() { return make_measured_btf_material(read_btf_table(test::striped_btf({12, 8}))); }

TEST(MeasuredBtf, AllStrategiesHaveTheSameExpectation) {
  test::expect_strategies_agree(test::two_objects(striped_material()), 0.05, 0.25);
}

TEST(MeasuredBtf, ControlLightFivePercentTooBrightIsSeen) {
  test::expect_a_difference(test::two_objects(striped_material()), test::two_objects(striped_material(), 1.05f));
}

/// The mean pixel of a sphere of f = albedo / pi that fills the picture, under an even sky of 1.
double furnace(float albedo) {
  const auto white = [&](const DirectionPair&, uint32_t, uint32_t) { return Rgb(albedo / kPi); };
  Scene scene;
  const Shared material =
      make_measured_btf_material(read_btf_table(test::MemoryBtf(test::ringed_layout(), {5, 3}, white)));
  scene.add_instance(scene.add_mesh(test::textured_sphere(48)), {}, {scene.add_material({.material = material})});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(Camera::look_at({0, -6, 3}, {0, 0, 0}, {0, 0, 1}, 0.22f, 1));
  scene.commit(2);
  RenderOptions options = test::small_options(Strategy::cosine, 256);
  options.bounces = 8;
  return test::mean_of(test::rendered(scene, options));
}

TEST(MeasuredBtf, WhiteIsNotSeenInAFurnace) {
  EXPECT_NEAR(furnace(1), 1.0, 1e-3);
  EXPECT_NEAR(furnace(0.95f), 0.95, 1e-3);
}

/// Pixels of a plane of 160 tiles are the mean of the tile: what is minified is not aliased.
TEST(MeasuredBtf, FarTilesKeepTheirMean) {
  const auto checkered = [](const DirectionPair&, uint32_t x, uint32_t y) {
    return Rgb((x + y) % 2 == 0 ? 0.6f / kPi : 0.1f / kPi);
  };
  const auto btf = test::MemoryBtf(test::ringed_layout(), {16, 16}, checkered);
  Scene scene;
  scene.add_instance(scene.add_mesh(test::repeating_square(4, 160)), {},
                     {scene.add_material({.material = make_measured_btf_material(read_btf_table(btf))})});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(test::camera_above(1));
  scene.commit(2);
  const auto pixels = test::rendered(scene, test::small_options(Strategy::cosine, 64));
  for (size_t i = 0; i < pixels.size(); i += 4) EXPECT_NEAR(pixels[i], 0.35f, 1e-3f);
}

}  // namespace
}  // namespace velour::measured_btf_test
