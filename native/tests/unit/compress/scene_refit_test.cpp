// Models of BTFs that are fitted anew to what scenes show.
#include "compress/scene_refit.h"

#include <gtest/gtest.h>

#include "btf/direction_sets.h"
#include "compress/scene_btf.h"
#include "compress/scene_levels.h"
#include "compress/scene_reduction.h"
#include "compress/seen_pictures.h"
#include "job/error.h"
#include "model/model_file.h"
#include "sphere/directions.h"
#include "support/striped_btf.h"

namespace velour {
namespace {

/// Hits seen from `degrees`, each under 40 lights from all over the hemisphere, in look-ups of `width` tiles.
SceneObservation seen_from(float degrees, double width, int hits = 16) {
  SceneObservation scene;
  for (int h = 0; h < hits; ++h) {
    const auto first = static_cast<uint32_t>(scene.wl.size());
    const Vec3 wv = direction(radians_from(degrees), static_cast<float>(h));
    for (const Vec3& wl : hemisphere_fibonacci(40)) {
      scene.wl.push_back(wl);
      scene.light.push_back(Rgb(wl.z));
    }
    const auto last = static_cast<uint32_t>(scene.wl.size());
    scene.hits.push_back({static_cast<uint64_t>(h), wv, first, (first + last) / 2, last, 1});
    scene.domain.view[static_cast<size_t>(degrees)] += 1;
    add_seen(scene.domain.surface, static_cast<float>(std::log2(width * 65536)), Vec2(0.061f * static_cast<float>(h)),
             1);
  }
  scene.domain.frames = 1;
  scene.domain.camera_rays = static_cast<uint64_t>(hits);
  return scene;
}

TEST(ViewsAround, AreThoseSeenAndTwoRingsMore) {
  const auto bonn = named_directions("81");
  const PairLayout layout(bonn, bonn);
  EXPECT_EQ(views_around(layout, {0, 90}).size(), 81u);
  EXPECT_EQ(views_around(layout, {0, 1}).size(), 1u + 6 + 12);  // rings are 15 degrees apart
  EXPECT_LT(views_around(layout, {74, 76}).size(), 81u);
}

TEST(SceneBtf, IsMeansOverTexelsOfTheViewsAskedFor) {
  const test::MemoryBtf fine = test::striped_btf({8, 4});
  const auto btf = scene_btf(fine, 1, {2, 5});
  EXPECT_EQ(btf->grid().width, 4u);
  EXPECT_EQ(btf->layout().views(), (std::vector<PolarAngles>{fine.layout().views()[2], fine.layout().views()[5]}));
  const uint64_t light = 3, pair = btf->layout().first(1) + light;
  std::vector<HalfBits> halves(btf->grid().texels() * 3);
  btf->read_pairs(pair, 1, halves);
  std::vector<float> coarse(halves.size());
  halves_to_floats(halves, coarse);
  const DirectionPair directions = fine.layout().directions(fine.layout().first(5) + light);
  Rgb mean(0);
  for (const uint32_t x : {2u, 3u}) {
    for (const uint32_t y : {0u, 1u}) mean += 0.25f * test::striped(directions, x, y);
  }
  for (size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(coarse[3 + c], mean[static_cast<int>(c)], 1e-3f * mean[static_cast<int>(c)]);
}

class Refit : public ::testing::Test {
 protected:
  Refit() {
    options_.method = CompressMethod::svd;
    options_.bytes = 300000;
  }
  Model full() { return compress_btf(btf_, options_, progress_); }
  Model reduced(const SceneObservation& scene) {
    options_.for_scene = std::make_shared<const SceneObservation>(scene);
    return compress_for_scene(btf_, options_, progress_);
  }

  test::MemoryBtf btf_ = test::striped_btf({32, 32});
  CompressOptions options_;
  Progress progress_;
};

TEST_F(Refit, PicturesTellGoodModelsFromBadOnes) {
  const SceneObservation scene = seen_from(20, 4.0 / 32);
  const auto seen = scene_btf(btf_, 1, views_around(btf_.layout(), {19, 22}));
  const SeenPictures pictures(*seen, scene, progress_);
  ASSERT_FALSE(pictures.empty());
  options_.companding = Companding::none;  // roots darken what lies between views and lights
  Model model = full();
  const double good = pictures.error(model.body, progress_);
  EXPECT_LT(good, 1e-3);
  auto& body = std::get<FactoredBtf>(model.body);
  body.axes *= 1.1f;
  EXPECT_NEAR(pictures.error(model.body, progress_), 0.01, 0.002);
}

TEST_F(Refit, AnEighthOfTheBytesServesAFarScene) {
  const Model full_model = full(), model = reduced(seen_from(20, 4.0 / 32));
  ASSERT_TRUE(model.scene);
  EXPECT_TRUE(model.scene->seen_views_alone);
  const auto& body = std::get<FactoredBtf>(model.body);
  EXPECT_LE(8 * body.parameter_bytes(), std::get<FactoredBtf>(full_model.body).parameter_bytes());
  EXPECT_EQ(body.grid.width, 16u);
  EXPECT_LE(model.scene->picture_error, kMoreError * model.scene->full_picture_error);
  const Model back = decode_model(encode_model(model), "small.velour");
  EXPECT_TRUE(back.scene->seen_views_alone);
  EXPECT_EQ(back.scene->picture_error, model.scene->picture_error);
}

TEST_F(Refit, DoesNotDependOnTheNumberOfThreads) {
  options_.threads = 1;
  const auto one = encode_model(Model{reduced(seen_from(20, 4.0 / 32)).body, {}, {}});
  options_.threads = 2;
  EXPECT_EQ(one, encode_model(Model{reduced(seen_from(20, 4.0 / 32)).body, {}, {}}));
}

TEST_F(Refit, WithoutLightLevelsAreLeftOut) {
  SceneObservation dark = seen_from(20, 4.0 / 32);
  for (Rgb& light : dark.light) light = Rgb(0.0f);
  const Model full_model = full(), model = reduced(dark);
  EXPECT_FALSE(model.scene->seen_views_alone);
  EXPECT_EQ(std::get<FactoredBtf>(model.body).pair_value, std::get<FactoredBtf>(full_model.body).pair_value);
}

}  // namespace
}  // namespace velour
