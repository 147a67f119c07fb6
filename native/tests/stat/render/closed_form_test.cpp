// Radiance against closed forms.
#include <gtest/gtest.h>

#include "support/level.h"
#include "support/polygon_irradiance.h"
#include "support/renders.h"

namespace velour::closed_form_test {
namespace {

using test::mean_of;
using test::rendered;
using test::small_options;

/// Adds the comparison of the picture's mean over eight renders with its closed form.
void expect_mean(const Scene& scene, const RenderOptions& options, double expected, test::ZTests& tests) {
  const std::string name = std::to_string(static_cast<int>(options.strategy));
  tests.add(name, test::independent_renders(scene, options, 8, 1).whole(), test::closed_form(expected));
}

constexpr Strategy kAll[] = {Strategy::uniform,      Strategy::cosine,          Strategy::table,
                             Strategy::srbf,         Strategy::light,           Strategy::mis,
                             Strategy::ggx,          Strategy::mis_ggx,         Strategy::product,
                             Strategy::dissertation, Strategy::mis_dissertation};

/// A large Lambertian square of albedo 0.6 seen from above; the picture lies well inside it.
Scene plane() {
  Scene scene;
  scene.add_mesh(test::square(100));
  scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.set_camera(test::camera_above(0.01f));
  return scene;
}

TEST(ClosedForm, PlaneUnderConstantSkyReflectsItsAlbedo) {
  Scene scene = plane();
  scene.set_environment(Environment::constant({1, 2, 4}));
  scene.commit(1);
  const double expected = 0.6 * static_cast<double>(luminance({1, 2, 4}));
  test::ZTests tests;
  for (Strategy strategy : kAll) expect_mean(scene, small_options(strategy, 256), expected, tests);
  EXPECT_TRUE(tests.agree());
  const auto pixels = rendered(scene, small_options(Strategy::cosine, 64));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean_of(pixels, c), 0.6 * std::pow(2, c), 1e-5 * std::pow(2, c));
}

TEST(ClosedForm, PlaneUnderTiltedSun) {
  test::ZTests tests;
  for (float angle : {0.0f, 0.02f}) {
    Scene scene = plane();
    Light sun;
    sun.angle = angle;
    sun.color = {3, 3, 3};
    const float c = 0.5f, s = std::sqrt(0.75f);  // 60 degrees from the normal
    sun.light_to_world.m[2] = s;
    sun.light_to_world.m[10] = c;
    scene.add_light(sun);
    scene.commit(1);
    for (Strategy strategy : kAll) {
      const bool finds_it = angle == 0 || strategy == Strategy::light || is_mixed(strategy);
      if (finds_it) expect_mean(scene, small_options(strategy, 64), 0.6 / kPiD * 3 * 0.5, tests);
    }
  }
  EXPECT_TRUE(tests.agree());
}

TEST(ClosedForm, PlaneUnderRectangleLight) {
  Scene scene = plane();
  Light light;
  light.type = Light::Type::rectangle;
  light.size = {2, 1};
  light.color = Rgb(10.0f);
  light.light_to_world = test::shift({0.7f, 0.2f, 1.5f});
  scene.add_light(light);
  scene.commit(1);
  const double radiance = 10 / (kPiD * 2);
  const double expected = 0.6 / kPiD * radiance *
                          test::polygon_irradiance({Vec3d(-0.3, -0.3, 1.5), Vec3d(1.7, -0.3, 1.5), Vec3d(1.7, 0.7, 1.5),
                                                    Vec3d(-0.3, 0.7, 1.5)});
  test::ZTests tests, control;
  // The irradiance changes by a thousandth over the five millimeters to each side that the picture spans.
  for (Strategy strategy : kAll) expect_mean(scene, small_options(strategy, 1024), expected, tests);
  EXPECT_TRUE(tests.agree());
  expect_mean(scene, small_options(Strategy::mis, 1024), 1.02 * expected, control);
  EXPECT_TRUE(control.differ());
}

TEST(ClosedForm, NegativeLightsTakeLightAway) {
  test::ZTests tests, control;
  for (const float size : {0.0f, 0.5f}) {
    Light light;
    light.type = Light::Type::point;
    light.size = {size, 0};
    light.color = Rgb(10.0f);
    light.light_to_world = test::shift({0.7f, 0.2f, 1.5f});
    Scene one = plane(), both = plane();
    light.color = Rgb(6.0f);
    one.add_light(light);
    light.color = Rgb(10.0f);
    both.add_light(light);
    light.color = Rgb(-4.0f);
    both.add_light(light);
    one.commit(1);
    both.commit(1);
    const double expected = mean_of(rendered(one, small_options(Strategy::mis, 1 << 14)));
    for (const Strategy strategy : {Strategy::light, Strategy::mis}) {
      expect_mean(both, small_options(strategy, 1024), expected, tests);
    }
    expect_mean(both, small_options(Strategy::mis, 1024), 10.0 / 6 * expected, control);
  }
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

TEST(ClosedForm, PointLightFallsWithTheSquare) {
  Scene scene = plane();
  Light light;
  light.type = Light::Type::point;
  light.color = Rgb(100.0f);
  light.light_to_world = test::shift({0, 0, 2});
  scene.add_light(light);
  scene.commit(1);
  const double expected = 0.6 / kPiD * 100 / (4 * kPiD * 4);
  EXPECT_NEAR(mean_of(rendered(scene, small_options(Strategy::uniform, 8))) / expected, 1, 1e-4);
}

TEST(ClosedForm, ManyDeltaLightsAreChosenWithoutBias) {
  Scene scene = plane();
  double expected = 0;
  for (int i = 0; i < 12; ++i) {
    Light light;
    light.type = Light::Type::point;
    const float height = 1 + 0.25f * static_cast<float>(i % 5), power = 1 + static_cast<float>(i);
    light.color = Rgb(power);
    light.light_to_world = test::shift({0, 0, height});
    scene.add_light(light);
    expected += 0.6 / kPiD * static_cast<double>(power) / (4 * kPiD * static_cast<double>(height * height));
  }
  scene.commit(1);
  test::ZTests tests;
  expect_mean(scene, small_options(Strategy::mis, 512), expected, tests);
  EXPECT_TRUE(tests.agree());
}

TEST(ClosedForm, LampWithoutShadowShinesThrough) {
  Scene scene = plane();
  scene.add_instance(0, test::shift({0, 0, 10}), {0});  // a lid above camera and plane
  Light sun;
  scene.add_light(sun);
  scene.commit(1);
  EXPECT_EQ(mean_of(rendered(scene, small_options(Strategy::mis, 8))), 0);
  sun.casts_shadow = false;
  scene.add_light(sun);
  scene.commit(1);
  EXPECT_NEAR(mean_of(rendered(scene, small_options(Strategy::mis, 8))), 0.6 / kPiD, 1e-5);
}

TEST(ClosedForm, WhiteFurnace) {
  // A convex body of albedo 1 vanishes in a constant environment: no strategy loses or makes energy.
  Scene scene;
  scene.add_mesh(test::sphere(64));
  scene.add_material({std::make_shared<test::Lambert>(1.0f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(test::camera_above(0.5f));
  scene.commit(1);
  for (Strategy strategy : kAll) {
    // Cells of 1/64 of a turn: at interpolated normals a little light falls below the facets.
    EXPECT_NEAR(mean_of(rendered(scene, small_options(strategy, 2048))), 1, 0.01) << static_cast<int>(strategy);
  }
}

TEST(ClosedForm, OpenCornerHalvesTheSky) {
  // A wall of infinite extent beside the point hides half of the hemisphere.
  Scene scene = plane();
  Affine wall;  // x to y, y to z, z to x: stands in the plane x = 0.02 and faces -x or +x alike
  const float m[12] = {0, 0, 1, 0.02f, 1, 0, 0, 0, 0, 1, 0, 0};
  std::copy(m, m + 12, wall.m);
  scene.add_mesh(test::square(1000));
  scene.add_material({std::make_shared<test::Lambert>(0.0f), Rgb(0.0f), false});
  scene.add_instance(1, wall, {1});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(Camera::look_at({0.01f, 0, 5}, {0.01f, 0, 0}, {0, 1, 0}, 0.001f, 1));
  scene.commit(1);
  test::ZTests tests;
  for (Strategy strategy : kAll) expect_mean(scene, small_options(strategy, 512), 0.3, tests);
  EXPECT_TRUE(tests.agree());
}

TEST(ClosedForm, ClosedSphereAddsUpBounces) {
  // Inside a sphere of emission 1 and albedo a, B bounces see 1 + a + ... + a^(B+1): the last term is direct light of
  // the last surface.
  for (Strategy strategy : kAll) {
    Scene scene;
    scene.add_mesh(test::sphere(32));
    scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(1.0f), false});
    scene.add_instance(0, {}, {0});
    scene.set_camera(Camera::look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1, 1));
    scene.commit(1);
    double expected = 1;
    for (int bounces = 0; bounces <= 3; ++bounces) {
      expected += std::pow(0.5, bounces + 1);
      const bool between = bounces == 1 || bounces == 2;  // the last sum has their terms
      if (between && strategy != Strategy::mis && !test::long_tests()) continue;
      RenderOptions options = small_options(strategy, 4096);
      options.bounces = bounces;
      EXPECT_NEAR(mean_of(rendered(scene, options)), expected, 0.015 * expected) << bounces;
    }
  }
}

TEST(ClosedForm, ContinuingRaysCountTheSkyOnce) {
  // Two facing infinite squares have no sky; a square beside nothing has all of it, bounces or not.
  Scene scene = plane();
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.commit(1);
  RenderOptions options = small_options(Strategy::mis, 2048);
  options.bounces = 3;
  EXPECT_NEAR(mean_of(rendered(scene, options)), 0.6, 0.006);
}

TEST(ClosedForm, WorkingSpaceTurnsMeasuredColorsOnly) {
  const Mat3 swap(Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));  // red to green, green to blue, blue to red
  for (bool measured : {false, true}) {
    Scene scene;
    scene.add_mesh(test::square(100));
    scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), measured});
    scene.add_instance(0, {}, {0});
    scene.set_camera(test::camera_above(0.01f));
    scene.set_environment(Environment::constant({1, 2, 4}));
    scene.set_working_space(measured ? swap * 0.5f : swap * 7.0f);
    scene.commit(1);
    const auto pixels = rendered(scene, small_options(Strategy::cosine, 64));
    EXPECT_NEAR(mean_of(pixels, 1), measured ? 0.6 : 1.2, 1e-4);
  }
}

TEST(ClosedForm, LargeScenesDoNotShadowThemselves) {
  for (float far : {0.0f, 1e3f, 1e6f}) {
    Scene scene;
    scene.add_mesh(test::square(1000));
    scene.add_material({std::make_shared<test::Lambert>(1.0f), Rgb(0.0f), false});
    scene.add_instance(0, test::shift({far, far, far}), {0});
    scene.set_environment(Environment::constant(Rgb(1.0f)));
    scene.set_camera(Camera::look_at(Vec3(far) + Vec3(0, -300, 500), Vec3(far), {0, 0, 1}, 0.8f, 1));
    scene.commit(1);
    EXPECT_NEAR(mean_of(rendered(scene, small_options(Strategy::cosine, 1024))), 1, 1e-3) << far;
  }
}

}  // namespace
}  // namespace velour::closed_form_test
