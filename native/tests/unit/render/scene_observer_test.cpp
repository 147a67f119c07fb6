// Observations of small scenes: what they hold, and that they are the same whatever the threads.
#include "usage/observe/scene_observer.h"

#include <gtest/gtest.h>

#include <numeric>

#include "material/shader_layers.h"
#include "render/path/direction_sampling.h"
#include "support/observed_scenes.h"
#include "usage/observation.h"

namespace velour::scene_observer_test {
namespace {

using test::ObservedLight;

SceneObservation observed(const Scene& scene, ObserverOptions options = {32, 32, 1, 2, 7}, uint32_t material = 0) {
  Progress progress;
  return observe(scene, material, options, progress);
}

Status status_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.status();
  }
  return Status::ok;
}

/// A large Lambertian square seen from above at its middle, lit by `light` if there is one.
Scene plane(const Light* light = nullptr) {
  Scene scene;
  scene.add_mesh(test::square(100));
  scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false});
  scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.set_camera(test::camera_above(0.01f));
  if (light != nullptr) scene.add_light(*light);
  scene.commit(1);
  return scene;
}

Light sun_of(float angle) {
  Light sun;
  sun.angle = angle;
  return sun;
}

TEST(SceneObserver, ThreadsDoNotChangeABit) {
  const Scene scene = test::observed_scene(ObservedLight::lamps, 1);
  const auto one = observed(scene, {32, 32, 2, 1, 7}), three = observed(scene, {32, 32, 2, 3, 7});
  EXPECT_EQ(one.domain.hash, three.domain.hash);
  EXPECT_EQ(content_hash(one), one.domain.hash);
  EXPECT_NE(one.domain.hash, observed(scene, {32, 32, 2, 1, 8}).domain.hash) << "another seed";
}

/// Largest difference of two channels of what arrives from a ball of a lamp, of the brightest.
float color_of_lamp(float pane_height) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::square(100)), {},
                     {scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false})});
  ShaderLayers layers;
  layers.transparent.emplace_back(Rgb(1, 0.5f, 0.2f));
  const auto pane = make_layered_material(std::move(layers));
  scene.add_instance(scene.add_mesh(test::square(100)), test::shift({0, 0, pane_height}),
                     {scene.add_material({.material = pane, .rec709_colors = false})});
  Light lamp;
  lamp.type = Light::Type::point;
  lamp.size = {0.3f, 0};
  lamp.light_to_world = test::shift({0, 0, 1});
  scene.add_light(lamp);
  scene.set_camera(test::camera_above(0.01f));
  scene.commit(1);
  const auto o = observed(scene);
  EXPECT_FALSE(o.light.empty());
  float largest = 0;
  for (const Rgb& light : o.light) largest = std::max(largest, (light.r - light.b) / light.r);
  return largest;
}

TEST(SceneObserver, ALampTakesNoColorFromWhatLiesBehindIt) {
  EXPECT_EQ(color_of_lamp(2), 0);
  EXPECT_NEAR(color_of_lamp(0.5f), 0.8, 1e-5);
}

TEST(SceneObserver, HoldsWhatItPromises) {
  const auto o = observed(test::observed_scene(ObservedLight::sky, 1));
  ASSERT_EQ(o.hits.size(), SceneObservation::kHits);
  EXPECT_EQ(o.domain.camera_rays, 65536u);
  EXPECT_EQ(o.domain.frames, 1u);
  EXPECT_TRUE(std::ranges::is_sorted(o.hits, {}, &ObservedHit::key));
  EXPECT_EQ(o.light.size(), o.wl.size());
  uint32_t next = 0;
  for (const ObservedHit& hit : o.hits) {
    EXPECT_EQ(hit.first, next);
    EXPECT_LE(hit.middle - hit.first, static_cast<uint32_t>(kObservedDirections));
    EXPECT_LE(hit.last - hit.middle, static_cast<uint32_t>(kObservedDirections));
    next = hit.last;
  }
  EXPECT_EQ(next, o.wl.size());
  for (const Vec3& wl : o.wl) EXPECT_GT(wl.z, 0);
}

TEST(SceneObserver, EveryCameraRayOfAnOpenPictureWeighsOne) {
  for (const auto& [width, height] : {std::pair{8, 8}, {640, 480}, {3000, 20}, {1, 1}, {65536, 3}, {2, 65536}}) {
    const auto o = observed(plane(), {width, height, 0, 2, 1});
    EXPECT_EQ(o.domain.weight(), static_cast<double>(o.domain.camera_rays));
    EXPECT_NEAR(static_cast<double>(o.domain.camera_rays), 65536, 700) << width << " x " << height;
    EXPECT_EQ(o.domain.view[0], o.domain.weight()) << "seen from above";
  }
}

TEST(SceneObserver, BouncesWeighWhatTheyCarry) {
  // Inside a sphere of albedo 1/2: 1 + 1/2 + 1/4.
  Scene scene;
  scene.add_mesh(test::sphere(32));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.set_camera(Camera::look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1, 1));
  scene.commit(1);
  const auto o = observed(scene, {16, 16, 2, 2, 1});
  EXPECT_NEAR(o.domain.weight() / static_cast<double>(o.domain.camera_rays), 1.75, 0.005);
}

TEST(SceneObserver, TheSumOfTermsIsTheIrradiance) {
  const Light sun = sun_of(0.05f);
  const auto o = observed(plane(&sun), {8, 8, 0, 2, 1});
  const double total = std::accumulate(o.light.begin(), o.light.end(), 0.0,
                                       [](double sum, const Rgb& c) { return sum + static_cast<double>(c.g); });
  EXPECT_NEAR(total / static_cast<double>(2 * o.hits.size()), 1, 1e-3);
}

TEST(SceneObserver, ALampAloneHasTheDensityOfItsSolidAngle) {
  const Light sun = sun_of(0.1f);
  const auto o = observed(plane(&sun), {8, 8, 0, 2, 1});
  const double solid_angle = 2 * kPiD * (1 - std::cos(0.05));
  EXPECT_NEAR(o.domain.light_density * solid_angle, 1, 1e-3);
  for (const ObservedHit& hit : o.hits) EXPECT_EQ(static_cast<double>(hit.light_density), o.domain.light_density);
}

TEST(SceneObserver, LightWithoutExtentIsInfinitelyDense) {
  const Light sharp = sun_of(0);
  const auto o = observed(plane(&sharp), {8, 8, 0, 2, 1});
  EXPECT_TRUE(std::isinf(o.domain.light_density));
  ASSERT_EQ(o.wl.size(), 2 * o.hits.size());
  EXPECT_FLOAT_EQ(o.light[0].g, 1);
}

TEST(SceneObserver, FaintSharpLightIsNotConcentrated) {
  for (const float share : {0.5e-3f, 2e-3f}) {
    Scene scene = plane();
    scene.set_environment(Environment::constant(Rgb(1.0f / kPi)));  // of irradiance 1
    Light sharp = sun_of(0);
    sharp.color = Rgb(share);
    scene.add_light(sharp);
    scene.commit(1);
    EXPECT_EQ(std::isinf(observed(scene, {8, 8, 0, 2, 1}).domain.light_density), share > 1e-3f);
  }
}

TEST(SceneObserver, AMaterialThatIsNotSeenGivesAnEmptyObservation) {
  const auto o = observed(plane(), {32, 32, 1, 2, 7}, 1);
  EXPECT_TRUE(o.hits.empty());
  EXPECT_EQ(o.domain.weight(), 0);
  EXPECT_EQ(o.domain.camera_rays, 65536u);
  EXPECT_EQ(o.domain.light_density, 0);
}

TEST(SceneObserver, ADarkSceneHasHitsWithoutTerms) {
  const auto o = observed(plane());
  EXPECT_EQ(o.hits.size(), SceneObservation::kHits);
  EXPECT_TRUE(o.wl.empty());
  EXPECT_EQ(o.domain.light_density, 0);
}

TEST(SceneObserver, WrongRequestsAreRefused) {
  const Scene scene = plane();
  EXPECT_EQ(status_of([&] { observed(scene, {0, 8, 0, 1, 0}); }), Status::invalid_argument);
  EXPECT_EQ(status_of([&] { observed(scene, {8, 65537, 0, 1, 0}); }), Status::invalid_argument);
  EXPECT_EQ(status_of([&] { observed(scene, {8, 8, -1, 1, 0}); }), Status::invalid_argument);
  EXPECT_EQ(status_of([&] { observed(scene, {8, 8, 0, -1, 0}); }), Status::invalid_argument);
  EXPECT_EQ(status_of([&] { observed(scene, {8, 8, 0, 1, 0}, 2); }), Status::invalid_argument);
  EXPECT_EQ(status_of([] { observed(Scene()); }), Status::invalid_state);
}

TEST(SceneObserver, StopsWhenCancelled) {
  const Scene scene = plane();
  Progress progress;
  progress.cancel();
  EXPECT_EQ(status_of([&] { observe(scene, 0, {}, progress); }), Status::cancelled);
}

TEST(DrawByWeight, DrawsInProportionAndWithReplacement) {
  // Two items, of weights 1 and 3: draws are independent of each other, so either comes many times.
  int first = 0, all = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    DrawByWeight<int> draws(64);
    for (int item = 0; item < 2; ++item) {
      draws.add(item, 1 + 2 * item, RandomStream(seed, static_cast<uint64_t>(item), 0));
    }
    for (const auto& draw : draws.sorted()) first += draw.item == 0 ? 1 : 0, ++all;
  }
  ASSERT_EQ(all, 400 * 64);
  const double deviation = std::sqrt(0.25 * 0.75 / all);
  EXPECT_NEAR(static_cast<double>(first) / all, 0.25, 3.5 * deviation);
}

TEST(DrawByWeight, OrderAndPartsDoNotMatter) {
  DrawByWeight<int> whole(16), parts[2] = {DrawByWeight<int>(16), DrawByWeight<int>(16)};
  const auto add = [](DrawByWeight<int>& to, int item) {
    to.add(item, 0.1 + item % 7, RandomStream(1, static_cast<uint64_t>(item), 0));
  };
  for (int item = 0; item < 500; ++item) add(whole, item);
  for (int item = 499; item >= 0; --item) add(parts[item % 2], item);
  parts[0].add(parts[1]);
  const auto a = whole.sorted(), b = parts[0].sorted();
  ASSERT_EQ(a.size(), 16u);
  ASSERT_EQ(b.size(), 16u);
  for (size_t i = 0; i < 16; ++i) EXPECT_EQ(std::pair(a[i].key, a[i].item), std::pair(b[i].key, b[i].item));
}

}  // namespace
}  // namespace velour::scene_observer_test
