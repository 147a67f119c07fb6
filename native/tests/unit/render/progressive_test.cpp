// A picture that grows while somebody watches: what it ends as, what it shows in between, stops and changes.
#include "render/progressive.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/test_scene.h"

namespace velour::progressive_test {
namespace {

std::shared_ptr<Scene> lit_scene() {
  auto scene = std::make_shared<Scene>();
  const uint32_t ground = scene->add_mesh(test::square(3)), ball = scene->add_mesh(test::sphere(12));
  scene->add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene->add_instance(ground, {}, {0});
  scene->add_instance(ball, test::shift({0, 0, 1}), {0});
  scene->set_environment(Environment::constant(Rgb(1.0f)));
  scene->add_light({});
  scene->set_camera(test::camera_above(2));
  scene->commit(2);
  return scene;
}

RenderOptions options_of(int width, int height, int spp) {
  RenderOptions o = test::small_options(Strategy::mis, spp);
  o.width = width;
  o.height = height;
  o.split = 5;
  o.bounces = 2;
  o.threads = 2;
  return o;
}

std::vector<float> read(const ProgressiveRender& render, const RenderOptions& options) {
  std::vector<float> pixels(static_cast<size_t>(4 * options.width * options.height));
  render.read(pixels);
  return pixels;
}

std::vector<float> finished(const std::shared_ptr<Scene>& scene, const RenderOptions& options) {
  ProgressiveRender render(scene, options);
  Progress progress;
  render.run(progress);
  return read(render, options);
}

TEST(Progressive, EndsAsTheRenderDoes) {
  const auto scene = lit_scene();
  for (int width : {37, 300}) {  // at once at full size; by way of coarser levels
    const RenderOptions options = options_of(width, 150, 12);
    EXPECT_EQ(finished(scene, options), test::rendered(*scene, options)) << width;
  }
}

TEST(Progressive, CommitsItsScene) {
  const auto scene = lit_scene();
  scene->add_instance(1, test::shift({1, 0, 2}), {0});
  EXPECT_FALSE(scene->committed());
  const RenderOptions options = options_of(37, 150, 12);
  const std::vector<float> picture = finished(scene, options);
  EXPECT_TRUE(scene->committed());
  EXPECT_EQ(picture, test::rendered(*scene, options));
}

TEST(Progressive, GoesOnWhereACancelStoppedIt) {
  const auto scene = lit_scene();
  const RenderOptions options = options_of(300, 150, 60);
  ProgressiveRender render(scene, options);
  int stops = 0;
  for (bool done = false; !done;) {
    Progress progress;
    std::thread stop([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      progress.cancel();
    });
    try {
      render.run(progress);
      done = true;
    } catch (const Error& error) {
      ASSERT_EQ(error.status(), Status::cancelled);
      ++stops;
    }
    stop.join();
  }
  EXPECT_GT(stops, 2);
  EXPECT_EQ(read(render, options), test::rendered(*scene, options));
}

TEST(Progressive, ShowsWholePicturesThatGrowFiner) {
  const auto scene = lit_scene();
  const RenderOptions options = options_of(400, 300, 400);
  ProgressiveRender render(scene, options);
  EXPECT_EQ(render.picture().width, 0);
  Progress progress;
  std::thread worker([&] { EXPECT_THROW(render.run(progress), Error); });
  int last = 0, sizes = 0;
  std::vector<float> pixels(4 * 400 * 300);
  while (last < 400) {
    const auto picture = render.read(pixels);
    ASSERT_GE(picture.width, last);
    if (picture.width > last) ++sizes;
    last = picture.width;
    // The sky is white and everywhere: a hole would be black.
    for (int i = 0; i < picture.width * picture.height; ++i) ASSERT_GT(pixels[static_cast<size_t>(4 * i + 3)], 0) << i;
  }
  progress.cancel();
  worker.join();
  EXPECT_GE(sizes, 2);
}

TEST(Progressive, CoarsePicturesAreOfTheSameView) {
  const auto scene = lit_scene();
  const RenderOptions options = options_of(400, 300, 64);
  ProgressiveRender render(scene, options);
  std::vector<float> pixels(4 * 400 * 300);
  Progress progress;
  std::thread worker([&] {
    try {
      render.run(progress);
    } catch (const Error&) {
    }
  });
  ProgressiveRender::Picture coarse;
  while ((coarse = render.read(pixels)).width == 0) std::this_thread::yield();
  progress.cancel();
  worker.join();
  ASSERT_LT(coarse.width, 400);
  const std::vector<float> fine = test::rendered(*scene, options);
  double error = 0, sum = 0;
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) {
      const int at = y * 300 / coarse.height * 400 + x * 400 / coarse.width;
      const double a = static_cast<double>(pixels[static_cast<size_t>(4 * (y * coarse.width + x))]),
                   b = static_cast<double>(fine[static_cast<size_t>(4 * at)]);
      error += (a - b) * (a - b);
      sum += b * b;
    }
  }
  EXPECT_LT(std::sqrt(error / sum), 0.3);
}

TEST(Progressive, TakesUpWhatHasChanged) {
  const auto scene = lit_scene();
  const RenderOptions options = options_of(40, 30, 10);
  ProgressiveRender render(scene, options);
  const auto run = [&] {
    scene->commit(2);
    render.restart();
    Progress progress;
    render.run(progress);
    return read(render, options);
  };
  const std::vector<float> first = run();
  scene->set_camera(test::camera_above(3));
  const std::vector<float> moved = run();
  EXPECT_NE(moved, first);
  EXPECT_EQ(moved, test::rendered(*scene, options));
  scene->clear_lights();
  const std::vector<float> darker = run();
  EXPECT_NE(darker, moved);
  EXPECT_EQ(darker, test::rendered(*scene, options));
  EXPECT_EQ(run(), darker);
}

/// Takes its time wherever it is looked at.
class SlowLambert : public test::Lambert {
 public:
  using Lambert::Lambert;
  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    std::this_thread::sleep_for(std::chrono::microseconds(30));
    return Lambert::prepare(wv, site, options, arena);
  }
};

/// The width of the first picture that there is to see.
int first_width(ProgressiveRender& render) {
  Progress progress;
  std::thread worker([&] { EXPECT_THROW(render.run(progress), Error); });
  int width = 0;
  while ((width = render.picture().width) == 0) std::this_thread::yield();
  progress.cancel();
  worker.join();
  return width;
}

TEST(Progressive, BeginsCoarserWhereTheFirstPictureWasLate) {
  const auto scene = lit_scene();
  scene->set_material(0, {std::make_shared<SlowLambert>(0.5f), Rgb(0.0f), false});
  const RenderOptions options = options_of(400, 300, 5);
  ProgressiveRender render(scene, options);
  EXPECT_EQ(first_width(render), 100);
  render.restart();
  EXPECT_EQ(first_width(render), 50);
  scene->set_material(0, {std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  render.restart();
  Progress progress;
  render.run(progress);
  EXPECT_EQ(read(render, options), test::rendered(*scene, options));
}

TEST(Progressive, RefusesASmallBufferAndABadOption) {
  const auto scene = lit_scene();
  RenderOptions options = options_of(40, 30, 1);
  ProgressiveRender render(scene, options);
  Progress progress;
  render.run(progress);
  std::vector<float> small(10);
  EXPECT_THROW(render.read(small), Error);
  options.split = 0;
  EXPECT_THROW(ProgressiveRender(scene, options), Error);
}

}  // namespace
}  // namespace velour::progressive_test
