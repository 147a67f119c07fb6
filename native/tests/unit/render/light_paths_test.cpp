// Clamping, Filter Glossy and Reflective Caustics.
#include "render/options.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "material/bsdf_materials.h"
#include "support/test_scene.h"

namespace velour::light_paths_test {
namespace {

constexpr size_t kPixels = 64;

Light lamp_above(float size, const Rgb& color) {
  Light lamp;
  lamp.type = Light::Type::point;
  lamp.size = {size, 0};
  lamp.color = color;
  lamp.light_to_world = test::shift({0.5f, 0.5f, 1.5f});
  return lamp;
}

/// A floor with a wall beside it, under a lamp; the camera sees the floor alone.
Scene corner(const Light& lamp) {
  Scene scene;
  const uint32_t matte = scene.add_material({std::make_shared<test::Lambert>(0.8f), Rgb(0.0f), false});
  const uint32_t square = scene.add_mesh(test::square(2));
  scene.add_instance(square, {}, {matte});
  const Affine wall{{0, 0, 1, -1.2f, 0, 1, 0, 0, -1, 0, 0, 0}};  // its normal along x
  scene.add_instance(square, wall, {matte});
  scene.add_light(lamp);
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return scene;
}

RenderOptions options_of(int bounces, const LightPathOptions& light_paths) {
  RenderOptions options = test::small_options(Strategy::mis, 64);
  options.bounces = bounces;
  options.light_paths = light_paths;
  return options;
}

float sum_of(const float* pixel) { return pixel[0] + pixel[1] + pixel[2]; }

/// A sharp lamp brings the same in every sample, so its pixels are clamped as they are.
TEST(Clamping, CapsTheMeanOfTheChannelsAndKeepsTheHue) {
  const Scene scene = corner(lamp_above(0, {40, 20, 10}));
  RenderOptions options = options_of(0, {});
  options.spp = options.split = 8;  // one camera ray
  const auto whole = test::rendered(scene, options);
  const float limit = sum_of(&whole[0]) / 3;
  options.light_paths.clamp_direct = limit;
  const auto clamped_ones = test::rendered(scene, options);
  size_t darker = 0;
  for (size_t i = 0; i < 4 * kPixels; i += 4) {
    const float* from = &whole[i];
    const float factor = std::min(1.0f, 3 * limit / sum_of(from));
    darker += factor < 0.999f ? 1 : 0;
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(clamped_ones[i + c], factor * from[c], 1e-5f * from[c]);
  }
  EXPECT_GT(darker, kPixels / 4);
  EXPECT_LT(darker, kPixels);
}

TEST(Clamping, TellsDirectFromIndirectLight) {
  const Scene scene = corner(lamp_above(0.1f, Rgb(20)));
  const auto direct = test::rendered(scene, options_of(0, {}));
  const auto both = test::rendered(scene, options_of(1, {}));
  const auto without_indirect = test::rendered(scene, options_of(1, {.clamp_indirect = 1e-9f}));
  const auto without_direct = test::rendered(scene, options_of(1, {.clamp_direct = 1e-9f}));
  for (size_t i = 0; i < 4 * kPixels; i += 4) {
    EXPECT_NEAR(without_indirect[i], direct[i], 1e-6f * direct[i]);
    EXPECT_NEAR(without_direct[i], both[i] - direct[i], 1e-5f * both[i]);
  }
  EXPECT_GT(test::mean_of(both), 1.01 * test::mean_of(direct));
}

/// A sample of Cycles is two directions here, however many share a camera ray.
TEST(Clamping, DoesNotDependOnTheSplit) {
  const Scene scene = corner(lamp_above(0.3f, Rgb(20)));
  const auto mean = [&](int split, float limit) {
    RenderOptions options = options_of(0, {.clamp_direct = limit});
    options.spp = 1024;
    options.split = split;
    return test::mean_of(test::rendered(scene, options));
  };
  const double whole = mean(8, 0);
  const auto limit = static_cast<float>(whole);
  const double one = mean(1, limit), eight = mean(8, limit);
  EXPECT_LT(one, 0.97 * whole);
  EXPECT_NEAR(one, eight, 0.005 * one);
}

TEST(Clamping, OfNothingLeavesEveryBit) {
  const Scene scene = corner(lamp_above(0.3f, Rgb(20)));
  EXPECT_EQ(test::rendered(scene, options_of(2, {})),
            test::rendered(scene, options_of(2, {.clamp_direct = 1e9f, .clamp_indirect = 1e9f})));
}

TEST(LobeFilter, IsThatOfThePath) {
  const LightPathOptions options{.filter_glossy = 2, .reflective_caustics = false};
  EXPECT_EQ(lobe_filter(options, {}).min_alpha, 0);
  EXPECT_EQ(lobe_filter(options, {.least_density = 3}).min_alpha, 0);
  EXPECT_FLOAT_EQ(lobe_filter(options, {.least_density = 0.5f}).min_alpha, 0.5f * std::sqrt(0.75f));
  EXPECT_EQ(lobe_filter({}, {.least_density = 0.5f}).min_alpha, 0);
  EXPECT_FALSE(lobe_filter(options, {}).diffuse_only);
  EXPECT_TRUE(lobe_filter(options, {.was_diffuse = true}).diffuse_only);
  EXPECT_FALSE(lobe_filter({}, {.was_diffuse = true}).diffuse_only);
}

/// A matte floor under a glossy ceiling: without caustics nothing comes from there, and a lamp's light over two bounces
/// is the floor's own.
TEST(Caustics, AreWhatGlossySurfacesBringToMatteOnes) {
  Scene scene;
  const uint32_t matte = scene.add_material({std::make_shared<test::Lambert>(0.8f), Rgb(0.0f), false});
  const uint32_t glossy = scene.add_material({make_glossy_material({.color = Rgb(0.9f)}), Rgb(0.0f), false});
  scene.add_instance(scene.add_mesh(test::square(2)), {}, {matte});
  scene.add_instance(scene.add_mesh(test::square(2)), test::shift({0, 0, 8}), {glossy});
  scene.add_light(lamp_above(0.2f, Rgb(20)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  const auto direct = test::rendered(scene, options_of(0, {}));
  const auto without = test::rendered(scene, options_of(1, {.reflective_caustics = false}));
  const auto with = test::rendered(scene, options_of(1, {}));
  for (size_t i = 0; i < 4 * kPixels; i += 4) EXPECT_NEAR(without[i], direct[i], 1e-6f * direct[i]);
  EXPECT_GT(test::mean_of(with), 1.001 * test::mean_of(direct));
}

TEST(LightPaths, RefuseWhatIsNoLimit) {
  const Scene scene = corner(lamp_above(0.3f, Rgb(20)));
  for (const LightPathOptions& wrong :
       {LightPathOptions{.clamp_direct = -1}, LightPathOptions{.clamp_indirect = std::nanf("")},
        LightPathOptions{.filter_glossy = std::numeric_limits<float>::infinity()}}) {
    EXPECT_THROW(test::rendered(scene, options_of(0, wrong)), Error);
  }
}

}  // namespace
}  // namespace velour::light_paths_test
