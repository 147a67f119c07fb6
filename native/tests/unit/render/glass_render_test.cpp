// Paths through glass.
#include <gtest/gtest.h>

#include <numbers>

#include "material/bsdf_materials.h"
#include "material/shader_layers.h"
#include "support/test_scene.h"

namespace velour::glass_render_test {
namespace {

std::shared_ptr<const Material> glass(float roughness, GgxLobe lobe = GgxLobe::whole) {
  return make_glass_material({.roughness = roughness, .refraction_roughness = roughness, .index = 1.5f, .lobe = lobe});
}

/// A ball under an even sky of 1, alone.
Scene ball(std::shared_ptr<const Material> material, uint32_t sides = 24) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::sphere(sides)), {}, {scene.add_material({.material = std::move(material)})});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(test::camera_above(1.2f));
  scene.commit(2);
  return scene;
}

double mean(const Scene& scene, Strategy strategy, int bounces, int spp = 64) {
  RenderOptions options = test::small_options(strategy, spp);
  options.bounces = bounces;
  return test::mean_of(test::rendered(scene, options));
}

TEST(GlassRender, SmoothBallIsNotSeenInAFurnace) {
  for (const Strategy strategy : {Strategy::mis, Strategy::srbf, Strategy::light, Strategy::uniform}) {
    EXPECT_NEAR(mean(ball(glass(0)), strategy, 40, 1024), 1, 6e-3) << static_cast<int>(strategy);
  }
  EXPECT_LT(mean(ball(glass(0)), Strategy::mis, 0), 0.6);  // the control: the far side is dark without bounces
}

TEST(GlassRender, RoughBallLosesLittleInAFurnace) {
  EXPECT_NEAR(mean(ball(glass(0.3f)), Strategy::srbf, 40), 1, 0.02);
  EXPECT_LT(mean(ball(glass(1, GgxLobe::single)), Strategy::srbf, 40), 0.9);
}

/// A pane, or nothing, above a wall; seen from above.
Scene window(std::shared_ptr<const Material> pane, SurfaceMaterial wall) {
  Scene scene;
  const uint32_t behind = scene.add_material(std::move(wall));
  scene.add_instance(scene.add_mesh(test::square(3)), test::shift({0, 0, -1}), {behind});
  if (pane != nullptr) {
    const uint32_t clear = scene.add_material({.material = std::move(pane)});
    scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 1}), {clear});
  }
  scene.set_camera(test::camera_above(0.3f));
  return scene;
}

SurfaceMaterial wall(float albedo, float emission = 0) {
  return {.material = std::make_shared<test::Lambert>(albedo), .emission = Rgb(emission)};
}

TEST(GlassRender, EmissionIsSeenOnceThroughAPane) {
  for (const bool drawn : {true, false}) {
    for (const Strategy strategy : {Strategy::mis, Strategy::srbf, Strategy::light, Strategy::cosine}) {
      for (const int bounces : {1, 2}) {
        Scene scene = window(glass(0), wall(0, 1));
        scene.set_drawn_to(0, drawn);
        scene.commit(2);
        // Emission that only the path itself meets depends on the lobe that it happens to follow.
        const double noise = !drawn && strategy == Strategy::light ? 0.02 : 1e-3;
        EXPECT_NEAR(mean(scene, strategy, bounces, 256), 0.96, noise) << drawn << static_cast<int>(strategy) << bounces;
      }
    }
  }
}

/// A wall that emits 1 below a pane that transmits 0.96 of it.
TEST(GlassRender, TransmittedRaysHaveTheirOwnVisibility) {
  const auto seen = [](uint8_t hidden_from, Strategy strategy) {
    Scene scene;
    const uint32_t wall_number = scene.add_material(wall(0, 1)), clear = scene.add_material({.material = glass(0)});
    scene.add_instance(scene.add_mesh(test::square(3)), test::shift({0, 0, -1}), {wall_number}, {}, hidden_from);
    scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 1}), {clear});
    scene.set_camera(test::camera_above(0.3f));
    scene.commit(2);
    return mean(scene, strategy, 1, 256);
  };
  for (const Strategy strategy : {Strategy::mis, Strategy::srbf, Strategy::light}) {
    EXPECT_EQ(seen(hidden::kFromTransmission, strategy), 0);
    EXPECT_NEAR(seen(hidden::kFromBounces, strategy), 0.96, 0.02);
  }
}

/// A pane beneath and above which the sky is 1: it transmits 0.96 and mirrors 0.04.
TEST(GlassRender, EnvironmentHiddenFromTransmissionIsOnlyMirrored) {
  const auto seen = [](uint8_t hidden_from) {
    Scene scene;
    const uint32_t clear = scene.add_material({.material = glass(0)});
    scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 1}), {clear});
    scene.set_environment(Environment::constant(Rgb(1.0f)));
    scene.hide_environment(hidden_from);
    scene.set_camera(test::camera_above(0.3f));
    scene.commit(2);
    return mean(scene, Strategy::mis, 1);
  };
  EXPECT_NEAR(seen(0), 1, 1e-3);
  EXPECT_NEAR(seen(hidden::kFromTransmission), 0.04, 1e-3);
  EXPECT_NEAR(seen(hidden::kFromBounces), 0.96, 1e-3);
}

TEST(GlassRender, MixesShowBothLobesAndLayers) {
  ShaderLayers layers;
  layers.reflecting.push_back({glass(0), {{{.value = 0.5f}}, {}}});
  layers.reflecting.push_back({make_translucent_material(Rgb(0.8f)), {{{.value = 0.5f}}, {}}});
  const auto pane = make_layered_material(layers);
  for (const Strategy strategy : {Strategy::mis, Strategy::srbf, Strategy::uniform}) {
    Scene scene = window(pane, wall(0));
    scene.set_environment(Environment::constant(Rgb(1.0f)));
    scene.commit(2);
    // The wall hides the sky below, up to the horizon; above, glass mirrors it.
    const double reflected = 0.5 * 0.04;
    Scene lit = window(pane, wall(0, 1));
    lit.set_environment(Environment::constant(Rgb(0.0f)));
    lit.commit(2);
    EXPECT_GT(mean(scene, strategy, 1, 256), reflected);
    // The wall fills 0.86 of the hemisphere below: 3 / sqrt(3^2 + 2^2) squared, roughly.
    const double through = 0.5 * 0.96, spread = 0.5 * 0.8;
    const double seen = mean(lit, strategy, 1, 256);
    EXPECT_GT(seen, through + 0.6 * spread) << static_cast<int>(strategy);
    EXPECT_LT(seen, through + 0.9 * spread) << static_cast<int>(strategy);
  }
}

/// Where no facet refracts, Cycles evaluates f although no sample goes there; it draws none from a sky of one color.
TEST(GlassRender, AnEvenSkyShinesThroughFacetsAlone) {
  const auto seen = [](const Environment& sky, Strategy strategy) {
    Scene scene;
    const auto pane = make_glass_material({.roughness = 0.8f, .index = 1.3f, .only_refracts = true});
    scene.add_instance(scene.add_mesh(test::square(3)), {}, {scene.add_material({.material = pane})});
    scene.set_environment(sky);
    scene.set_camera(test::camera_above(0.8f));
    scene.commit(2);
    return mean(scene, strategy, 1, 256);
  };
  const std::vector<float> ones(size_t{8} * 4 * 3, 1.0f);
  const auto image = Environment::image({8, 4, 3, ones}, 1, Mat3(1.0f));
  const double expected = seen(image, Strategy::srbf);
  EXPECT_LT(expected, 1);
  for (const Strategy strategy : {Strategy::srbf, Strategy::mis, Strategy::light, Strategy::product}) {
    EXPECT_NEAR(seen(Environment::constant(Rgb(1.0f)), strategy), expected, 2e-3) << static_cast<int>(strategy);
  }
  EXPECT_GT(seen(image, Strategy::mis), expected + 0.02);
}

/// Cycles does the same: without a lobe that has a width, no ray finds a sharp sun, and shadow rays do not pass.
TEST(GlassRender, IsOpaqueToShadowRays) {
  const auto under_sun = [](std::shared_ptr<const Material> pane) {
    Scene scene = window(std::move(pane), wall(0.5f));
    scene.add_light({.type = Light::Type::sun, .color = Rgb(2.0f), .light_to_world = {}});
    scene.commit(2);
    return mean(scene, Strategy::mis, 2, 16);
  };
  EXPECT_NEAR(under_sun(nullptr), 1 / std::numbers::pi, 1e-3);
  EXPECT_EQ(under_sun(glass(0)), 0);
}

}  // namespace
}  // namespace velour::glass_render_test
