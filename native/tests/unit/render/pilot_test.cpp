// The strategy `automatic`: what its pilot chooses, and what the choice must not depend on.
#include "render/pilot.h"

#include <gtest/gtest.h>

#include "support/proof_materials.h"
#include "support/test_scene.h"

namespace velour::pilot_test {
namespace {

constexpr int kSide = 64;

/// A diffuse square (material 0) beside a polished one (material 1), under a sky with an edge and a small bright lamp.
Scene two_squares() {
  Scene scene;
  const uint32_t square = scene.add_mesh(test::square(1));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_material({test::highlight_material(3000), Rgb(0.0f), false});
  scene.add_instance(square, test::shift({-1, 0, 0}), {0});
  scene.add_instance(square, test::shift({1, 0, 0}), {1});
  std::vector<float> sky(3 * 32 * 16, 0.1f);
  std::fill_n(sky.begin(), sky.size() / 2, 1.0f);
  scene.set_environment(Environment::image({32, 16, 3, sky}, 1, Mat3(1.0f)));
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.size = {0.2f, 0.2f};
  lamp.color = Rgb(200.0f);
  lamp.light_to_world = test::shift({-1.5f, 1, 3});
  scene.add_light(lamp);
  scene.set_camera(test::camera_above(2));
  scene.commit(2);
  return scene;
}

RenderOptions square_options(Strategy strategy, int spp) {
  RenderOptions options = test::small_options(strategy, spp);
  options.width = options.height = kSide;
  return options;
}

std::vector<float> rendered_crop(const Scene& scene, const RenderOptions& options, RenderReport* report = nullptr) {
  Film film(options.window());
  Progress progress;
  const RenderReport r = render(scene, options, film, progress);
  if (report != nullptr) *report = r;
  std::vector<float> pixels(static_cast<size_t>(4 * film.width() * film.height()));
  film.read_pass("Combined", pixels);
  return pixels;
}

TEST(Pilot, DiffuseMaterialsGetMoreOfTheLights) {
  const Scene scene = two_squares();
  Progress progress;
  const RenderOptions options = square_options(Strategy::automatic, 4096);
  RenderContext context(scene, options, progress);
  ASSERT_TRUE(pilot_pays(context));
  EXPECT_FALSE(pilot_tries_products(context));  // a fit of the sky would take longer than this image
  const RenderReport::Pilot report = choose_mixing(context, progress);
  ASSERT_EQ(context.mixing.size(), 2u);
  EXPECT_EQ(context.mixing[0].light_share, 0.75f);
  EXPECT_EQ(context.mixing[1].light_share, 0.5f);
  EXPECT_GT(report.pixels, 500u);
  EXPECT_NEAR(report.light_share, 0.625, 0.02);
  EXPECT_EQ(report.products, 0.0);
}

TEST(Pilot, TriesProductsInLongRenders) {
  const Scene scene = two_squares();
  Progress progress;
  const RenderOptions options = square_options(Strategy::automatic, 16384);
  RenderContext context(scene, options, progress);
  EXPECT_TRUE(pilot_tries_products(context));
}

TEST(Pilot, ChoiceDependsOnNeitherThreadsNorCrop) {
  const Scene scene = two_squares();
  RenderOptions options = square_options(Strategy::automatic, 2048);
  options.crop = {8, 30, 24, 34};  // of the diffuse square
  RenderReport report;
  const std::vector<float> both = rendered_crop(scene, options, &report);
  EXPECT_TRUE(report.pilot.has_value());
  options.threads = 1;
  EXPECT_EQ(rendered_crop(scene, options), both);
  options.crop.x1 = 16;
  const std::vector<float> left = rendered_crop(scene, options);
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 4 * 8; ++i)
      EXPECT_EQ(left[static_cast<size_t>(row * 32 + i)], both[static_cast<size_t>(row * 64 + i)]);
  }
  options.strategy = Strategy::mis;
  EXPECT_NE(rendered_crop(scene, options), left);
  options.light_share = 0.75f;
  EXPECT_EQ(rendered_crop(scene, options), left);
}

TEST(Pilot, SmallImagesAreLitAsByMis) {
  const Scene scene = two_squares();
  RenderReport report;
  const std::vector<float> image = rendered_crop(scene, square_options(Strategy::automatic, 64), &report);
  EXPECT_FALSE(report.pilot.has_value());
  EXPECT_EQ(image, rendered_crop(scene, square_options(Strategy::mis, 64)));
}

}  // namespace
}  // namespace velour::pilot_test
