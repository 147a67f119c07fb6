// The ray with which a path goes on is a shadow ray, too: the same light arrives as by rays of its own.
#include <gtest/gtest.h>

#include "support/observed_scenes.h"
#include "support/proof_strategies.h"
#include "support/renders.h"
#include "support/significance.h"

namespace velour::shared_rays_test {
namespace {

using test::NamedStrategy;
using test::ObservedLight;

constexpr int kBounces = 3;
constexpr float kControl = 1.06f;  // factor of what the sphere reflects

/// Every shadow ray is traced by itself where any surface is hidden from them: a speck that no ray of the picture
/// meets.
Scene with_speck(Scene scene) {
  const uint32_t gray = scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(scene.add_mesh(test::square(0.001f)), test::shift({0, 0, -50}), {gray}, {}, hidden::kFromShadows);
  scene.commit(2);
  return scene;
}

test::PictureMeans pictures(const Scene& scene, const NamedStrategy& s, uint64_t seed) {
  RenderOptions options = test::small_options(s.strategy, 96);
  options.width = options.height = 16;
  options.heuristic = s.heuristic;
  options.split = 2;
  options.bounces = kBounces;
  return test::independent_renders(scene, options, 16, seed);
}

TEST(SharedRays, BringTheLightThatShadowRaysBring) {
  test::ZTests tests, control;
  for (const auto& [name, light] : {std::pair{"sky", ObservedLight::sky}, std::pair{"lamps", ObservedLight::lamps}}) {
    const Scene apart = with_speck(test::observed_scene(light, 1)), shared = test::observed_scene(light, 1);
    const NamedStrategy mis{"mis", Strategy::mis};
    const test::PictureMeans expected = pictures(apart, mis, 1'000'000);
    for (const NamedStrategy& s : {mis, NamedStrategy{"product", Strategy::product}}) {
      const std::string both = std::string(name) + " " + s.name;
      compare(both, pictures(shared, s, 1), expected, tests);
      EXPECT_LT(tests.smallest_bias(both + " whole"), 0.03) << both;
    }
    compare(name, pictures(test::observed_scene(light, kControl), mis, 1), expected, control);
  }
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

TEST(SharedRays, SaveOneOfThreeRaysAVertex) {
  const Scene shared = test::observed_scene(ObservedLight::sky, 1);
  const Scene apart = with_speck(test::observed_scene(ObservedLight::sky, 1));
  RenderOptions options = test::small_options(Strategy::mis, 64);
  options.split = 2;
  options.bounces = kBounces;
  const auto rays = [&](const Scene& scene) {
    RenderReport report;
    test::rendered(scene, options, "Combined", &report);
    return static_cast<double>(report.rays);
  };
  EXPECT_LT(rays(shared), 0.85 * rays(apart));
}

}  // namespace
}  // namespace velour::shared_rays_test
