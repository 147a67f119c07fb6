// What an observation says of a picture is what a render says.
#include <gtest/gtest.h>

#include "support/level.h"
#include "support/observed_scenes.h"

namespace velour::observation_test {
namespace {

using test::ObservedLight;

constexpr uint64_t kRenders = 12, kObservations = 44;
constexpr float kScales[] = {0, 0.5f, 1.5f, 2};
constexpr double kStencil[] = {1.0 / 6, -8.0 / 6, 8.0 / 6, -1.0 / 6};  // of the derivative at 1, exact to degree 4

/// How the picture's mean luminance changes with a factor on f, at 1. With b bounces the picture is a polynomial of
/// degree b + 1 in the factor, so up to three bounces its derivative needs no limit.
test::Estimate rendered_derivative(ObservedLight light, std::shared_ptr<const Material> material, int bounces) {
  std::vector<Scene> scenes;
  for (const float scale : kScales) scenes.push_back(test::observed_scene(light, scale, material));
  RenderOptions options = test::small_options(Strategy::mis, 44);
  options.width = options.height = 32;
  options.bounces = bounces;
  test::RunningMean derivative;
  for (options.seed = 0; options.seed < kRenders; ++options.seed) {
    double sum = 0;
    for (size_t i = 0; i < scenes.size(); ++i) {
      const auto pixels = test::rendered(scenes[i], options);
      double mean = 0;
      for (size_t p = 0; p < pixels.size(); p += 4) {
        mean += static_cast<double>(luminance({pixels[p], pixels[p + 1], pixels[p + 2]}));
      }
      sum += kStencil[i] * mean * 4 / static_cast<double>(pixels.size());
    }
    derivative.add(sum);
  }
  return derivative.estimate();
}

/// The same from observations: each hit with its throughput is one place where f acts.
test::Estimate observed_derivative(ObservedLight light, std::shared_ptr<const Material> of, int bounces) {
  const Scene scene = test::observed_scene(light, 1, std::move(of));
  const Material& material = *scene.materials()[test::kObservedMaterial].material;
  test::RunningMean derivative;
  for (uint64_t seed = 0; seed < kObservations; ++seed) {
    Progress progress;
    const ObserverOptions options{32, 32, bounces, 2, seed};
    derivative.add(test::observed_radiance(observe(scene, test::kObservedMaterial, options, progress), material));
  }
  return derivative.estimate();
}

void expect_changes_as_a_render(ObservedLight light, const std::shared_ptr<const Material>& material,
                                int most_bounces) {
  test::ZTests tests(1 - std::pow(1 - 0.01, 1.0 / 3));
  test::Estimate observed[3], rendered[3];
  for (int bounces = 0; bounces <= most_bounces; ++bounces) {
    observed[bounces] = observed_derivative(light, material, bounces);
    rendered[bounces] = rendered_derivative(light, material, bounces);
    tests.add("bounces " + std::to_string(bounces), observed[bounces], rendered[bounces]);
  }
  EXPECT_TRUE(tests.agree());
  for (int bounces = 0; bounces <= most_bounces; ++bounces) {
    EXPECT_LT(tests.smallest_bias("bounces " + std::to_string(bounces)), 0.05) << "too noisy to prove anything";
  }
  // What an f one tenth too large, and an observation without the bounce of the render, would give.
  test::ZTests brighter, without_bounce;
  brighter.add("f", {1.1 * observed[1].mean, 1.1 * observed[1].error, observed[1].degrees}, rendered[1]);
  EXPECT_TRUE(brighter.differ());
  without_bounce.add("bounce", observed[0], rendered[1]);
  EXPECT_TRUE(without_bounce.differ());
}

class ObservedPicture : public ::testing::TestWithParam<ObservedLight> {};

TEST_P(ObservedPicture, ChangesWithFAsARenderDoes) {
  const bool twice = GetParam() == ObservedLight::lamps || test::long_tests();
  expect_changes_as_a_render(GetParam(), test::highlight_material(10), twice ? 2 : 1);
}

TEST(ObservedTranslucency, ChangesWithFAsARenderDoes) {
  expect_changes_as_a_render(ObservedLight::sky, test::translucent_material(), 1);
  if (test::long_tests()) expect_changes_as_a_render(ObservedLight::delta_lights, test::translucent_material(), 1);
}

INSTANTIATE_TEST_SUITE_P(Lights, ObservedPicture,
                         ::testing::Values(ObservedLight::sky, ObservedLight::lamps, ObservedLight::delta_lights));

}  // namespace
}  // namespace velour::observation_test
