// What a render promises beside its light: bits, counts, limits, passes.
#include "render/render.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "support/test_scene.h"
#include "unit/render/busy_scene.h"

namespace velour::render_test {
namespace {

using test::busy_scene;
using test::rendered;
using test::small_options;

RenderOptions odd_options(Strategy strategy) {
  RenderOptions o = small_options(strategy, 37);
  o.width = 37;
  o.height = 21;
  o.split = 5;
  o.bounces = 2;
  return o;
}

TEST(Render, BitsDoNotDependOnThreadsOrPasses) {
  const Scene scene = busy_scene();
  for (Strategy strategy : {Strategy::mis, Strategy::light, Strategy::uniform}) {
    RenderOptions options = odd_options(strategy);
    options.threads = 1;
    const std::vector<float> expected = rendered(scene, options);
    for (int threads : {2, 3}) {
      for (int pass : {0, 1, 3, 1000}) {
        options.threads = threads;
        options.camera_rays_per_pass = pass;
        EXPECT_EQ(rendered(scene, options), expected) << threads << " threads, passes of " << pass;
      }
    }
    options.seed = 1;
    EXPECT_NE(rendered(scene, options), expected);
  }
}

TEST(Render, CountsEverySample) {
  const Scene scene = busy_scene();
  RenderReport report;
  const std::vector<float> count = rendered(scene, odd_options(Strategy::mis), "Sample Count", &report);
  for (float c : count) EXPECT_EQ(c, 37);
  EXPECT_EQ(report.spp, 37u);
  EXPECT_EQ(report.nan_samples, 0u);
  EXPECT_GT(report.rays, 37u * 21 * 8);
  EXPECT_GT(report.samples_per_second, 0);
  EXPECT_GT(report.noise, 0);
  EXPECT_EQ(report.passes, 4u);  // 1, 1, 2, 4 of 8 camera rays
}

TEST(Render, CountsAndLeavesOutWhatIsNotANumber) {
  const Scene scene = busy_scene(std::make_shared<test::BrokenLambert>(0.5f));
  RenderReport report;
  for (float value : rendered(scene, odd_options(Strategy::cosine), "Combined", &report)) {
    EXPECT_TRUE(std::isfinite(value));
  }
  EXPECT_GT(report.nan_samples, 1000u);
}

/// Seconds from a cancel in the middle of a long render to its end.
double seconds_to_cancel(const Scene& scene) {
  RenderOptions options = small_options(Strategy::mis, 1 << 20);
  options.width = options.height = 512;
  Film film(512, 512);
  Progress progress;
  std::chrono::steady_clock::time_point asked;
  std::thread watcher([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    asked = std::chrono::steady_clock::now();
    progress.cancel();
  });
  try {
    render(scene, options, film, progress);
    ADD_FAILURE() << "was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::cancelled);
  }
  const auto ended = std::chrono::steady_clock::now();
  watcher.join();
  EXPECT_LT(progress.fraction(), 1);
  std::vector<float> count(512 * 512);
  film.read_pass("Sample Count", count);  // what was done stays readable
  return std::chrono::duration<double>(ended - asked).count();
}

/// On the surface that the camera sees, and on one that only bounces meet because it is not light-sampled.
TEST(Render, LeavesOutAndCountsEmissionThatIsNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const bool is_seen : {true, false}) {
    Scene scene;
    const auto lambert = std::make_shared<test::Lambert>(0.5f);
    const uint32_t emitter = scene.add_material({lambert, Rgb(kInfinity, 1, 1), false}),
                   matte = scene.add_material({lambert, Rgb(0.0f), false}), square = scene.add_mesh(test::square(9));
    scene.set_drawn_to(emitter, false);
    scene.add_instance(square, {}, {is_seen ? emitter : matte});
    if (!is_seen) scene.add_instance(square, test::shift({0, 0, 6}), {emitter});
    scene.set_environment(Environment::constant(Rgb(0.5f)));
    scene.set_camera(test::camera_above(0.5f));
    scene.commit(1);
    RenderOptions options = small_options(Strategy::light, 16);
    options.split = 1;
    options.bounces = 1;
    RenderReport report;
    EXPECT_TRUE(std::isfinite(test::mean_of(rendered(scene, options, "Combined", &report)))) << is_seen;
    EXPECT_GT(report.nan_samples, 500u) << is_seen;
    options.bounces = 0;
    PassOptions passes;
    passes.asked = pass::kDenoisingAlbedo;
    Film film(options.window(), passes);
    Progress progress;
    render(scene, options, film, progress);
    std::vector<float> albedo(static_cast<size_t>(3 * options.width * options.height));
    film.read_pass("Denoising Albedo", albedo);
    EXPECT_TRUE(std::isfinite(test::mean_of(albedo, 0, 3))) << is_seen;
  }
}

TEST(Render, CancelEndsItWithinATenthOfASecond) {
  const Scene scene = busy_scene();
  double best = 1;  // of a few: other programs may hold the processor
  for (int i = 0; i < 5 && best > 0.1; ++i) best = std::min(best, seconds_to_cancel(scene));
  EXPECT_LT(best, 0.1);
}

TEST(Render, TimeLimitStopsAtAWholePass) {
  const Scene scene = busy_scene();
  RenderOptions options = small_options(Strategy::mis, 1 << 20);
  options.width = options.height = 64;
  options.time_limit = 0.3;
  RenderReport report;
  const std::vector<float> count = rendered(scene, options, "Sample Count", &report);
  EXPECT_LT(report.seconds, 3);
  EXPECT_GT(report.spp, 8u);
  EXPECT_LT(report.spp, 1u << 20);
  for (float c : count) EXPECT_EQ(c, static_cast<float>(report.spp));
}

TEST(Render, FilmCanBeReadMeanwhile) {
  const Scene scene = busy_scene();
  RenderOptions options = small_options(Strategy::mis, 4096);
  Film film(8, 8);
  Progress progress;
  std::thread worker([&] { render(scene, options, film, progress); });
  std::vector<float> pixels(8 * 8 * 4);
  for (int i = 0; i < 1000; ++i) film.read_pass("Combined", pixels);
  worker.join();
  EXPECT_DOUBLE_EQ(progress.fraction(), 1);
}

TEST(Render, AlphaDepthAndNormalOfHitsAndMisses) {
  Scene scene;
  const uint32_t mesh = scene.add_mesh(test::square(1));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(mesh, test::shift({0, 0, 1}), {0});
  scene.set_environment(Environment::constant({2, 3, 4}));
  scene.set_camera(test::camera_above(2));  // the square at height 1 fills the middle
  scene.commit(1);
  RenderOptions options = small_options(Strategy::mis);
  const auto opaque = rendered(scene, options);
  EXPECT_EQ(opaque[1], 3);  // a corner of the picture
  EXPECT_EQ(opaque[3], 1);
  options.hide_world = true;
  const auto hidden = rendered(scene, options);
  EXPECT_EQ(hidden[1], 0);
  EXPECT_EQ(hidden[3], 1);
  EXPECT_EQ(hidden[4 * (8 * 4 + 4) + 1], opaque[4 * (8 * 4 + 4) + 1]);  // it lights as before
  options.transparent = true;
  const auto transparent = rendered(scene, options);
  EXPECT_EQ(transparent[1], 0);
  EXPECT_EQ(transparent[3], 0);
  const size_t middle = 8 * 4 + 4;
  EXPECT_EQ(transparent[4 * middle + 3], 1);
  const auto depth = rendered(scene, options, "Depth");
  EXPECT_NEAR(depth[middle], 4, 1e-5f);
  EXPECT_EQ(depth[0], 1e10f);
  const auto normal = rendered(scene, options, "Normal");
  EXPECT_NEAR(normal[3 * middle + 2], 1, 1e-6f);
  EXPECT_EQ(normal[2], 0);
}

TEST(Render, OrthographicCameraSeesParallel) {
  Scene scene;
  const uint32_t mesh = scene.add_mesh(test::square(1));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(1.0f), false});
  scene.add_instance(mesh, test::shift({0, 0, -50}), {0});
  Camera camera;
  camera.type = Camera::Type::orthographic;
  const float window[] = {-2, 2, -2, 2};
  std::copy(window, window + 4, camera.window);
  scene.set_camera(camera);
  scene.commit(1);
  RenderOptions options = small_options(Strategy::mis, 8);
  options.width = options.height = 16;
  // However far, the square of side 2 covers a quarter of the window of side 4.
  EXPECT_DOUBLE_EQ(test::mean_of(rendered(scene, options)), 0.25);
  EXPECT_NEAR(rendered(scene, options, "Depth")[8 * 16 + 8], 50, 1e-4f);
  camera.clip_end = 49;
  scene.set_camera(camera);
  scene.commit(1);
  EXPECT_EQ(test::mean_of(rendered(scene, options)), 0);
}

TEST(Render, MirroredAndFlippedInstancesLookTheSame) {
  for (const Vec3& scale : {Vec3(1.0f), Vec3(-1, 1, 1), Vec3(1, 1, -1), Vec3(-1, -1, -1)}) {
    Scene scene;
    const uint32_t mesh = scene.add_mesh(test::sphere(24));
    scene.add_material({std::make_shared<test::Lambert>(0.8f), Rgb(0.0f), false});
    scene.add_instance(mesh, test::shift(Vec3(0.0f), scale), {0});
    scene.add_light({});  // from above
    scene.set_camera(test::camera_above(0.5f));
    scene.commit(1);
    const RenderOptions options = small_options(Strategy::mis);
    const double light = test::mean_of(rendered(scene, options));
    EXPECT_GT(light, 0.2) << scale.x << scale.y << scale.z;
    EXPECT_GT(test::mean_of(rendered(scene, options, "Normal"), 2, 3), 0.8);
  }
}

TEST(Render, RayShareIsAShare) {
  const Scene scene = busy_scene();
  RenderOptions options = small_options(Strategy::mis, 32);
  options.width = options.height = 200;
  options.measure_ray_share = true;
  RenderReport report;
  rendered(scene, options, "Combined", &report);
  ASSERT_TRUE(report.ray_share.has_value());
  EXPECT_GT(*report.ray_share, 0.05);
  EXPECT_LT(*report.ray_share, 1.1);
  ASSERT_EQ(report.stages.size(), 2u);
  EXPECT_EQ(report.stages[1].name, "replay");
  options.measure_ray_share = false;
  rendered(scene, options, "Combined", &report);
  EXPECT_FALSE(report.ray_share.has_value());
}

TEST(Render, EmptyScenesAndNoLightAreBlackNotBroken) {
  Scene scene;
  scene.commit(1);
  RenderReport report;
  EXPECT_EQ(test::mean_of(rendered(scene, small_options(Strategy::mis), "Combined", &report)), 0);
  const uint32_t mesh = scene.add_mesh(test::square(1));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(mesh, {}, {0});
  scene.set_camera(test::camera_above(0.5f));
  scene.commit(1);
  for (int s = 0; s <= 7; ++s) {
    EXPECT_EQ(test::mean_of(rendered(scene, small_options(static_cast<Strategy>(s)), "Combined", &report)), 0);
    EXPECT_EQ(report.nan_samples, 0u);
  }
}

TEST(Render, RefusesWrongOptionsByName) {
  const Scene scene = busy_scene();
  Film film(8, 8);
  Progress progress;
  const auto refused = [&](auto change, const char* name) {
    RenderOptions options = small_options(Strategy::mis);
    change(options);
    try {
      render(scene, options, film, progress);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_argument);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused([](RenderOptions& o) { o.spp = 0; }, "spp");
  refused([](RenderOptions& o) { o.split = 100; }, "split");
  refused([](RenderOptions& o) { o.spp = o.split * ((1 << 24) + 1), o.time_limit = 1e-3; }, "seeds");
  refused([](RenderOptions& o) { o.bounces = -1; }, "bounces");
  refused([](RenderOptions& o) { o.width = 9; }, "size");
  refused([](RenderOptions& o) { o.time_limit = -1; }, "time_limit");
  refused([](RenderOptions& o) { o.strategy = static_cast<Strategy>(static_cast<int>(kLastStrategy) + 1); },
          "strategy");
  Scene uncommitted;
  EXPECT_THROW(render(uncommitted, small_options(Strategy::mis), film, progress), Error);
}

}  // namespace
}  // namespace velour::render_test
