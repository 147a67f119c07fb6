// Models of BTFs that are fitted anew to what scenes show.
#include "usage/btf/scene_reduction.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "btf/measure/pair_layout.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "support/striped_btf.h"
#include "usage/btf/scene_btf.h"
#include "usage/observation.h"

namespace velour::scene_refit_test {
namespace {

/// Hits seen from `degrees`, each under 40 lights from all over the hemisphere, twice, in look-ups of `width` tiles.
SceneObservation seen_from(float degrees, double width, int hits = 16) {
  SceneObservation scene;
  const std::vector<Vec3> lights = hemisphere_fibonacci(40);
  for (int h = 0; h < hits; ++h) {
    const auto first = static_cast<uint32_t>(scene.wl.size());
    const Vec3 wv = direction(radians_from(degrees), static_cast<float>(h));
    for (int i = 0; i < 80; ++i) {
      scene.wl.push_back(lights[static_cast<size_t>(i % 40)]);
      scene.light.push_back(Rgb(scene.wl.back().z));
    }
    const auto last = static_cast<uint32_t>(scene.wl.size());
    scene.hits.push_back({static_cast<uint64_t>(h), wv, first, (first + last) / 2, last, 1});
    scene.domain.view[static_cast<size_t>(degrees)] += 1;
    add_view(scene.domain.surface.views, wv, 1);
    add_seen(scene.domain.surface, static_cast<float>(std::log2(width * 65536)), Vec2(0.061f * static_cast<float>(h)),
             1);
  }
  scene.domain.frames = 1;
  scene.domain.camera_rays = static_cast<uint64_t>(hits);
  return scene;
}

/// Hits of random lights, `terms` in either half, of a sky that is bright about one place.
SceneObservation lit_at_random(int terms, uint64_t seed) {
  SceneObservation scene = seen_from(20, 4.0 / 32, 12);
  RandomStream random(seed, 0, 0);
  scene.wl.clear();
  scene.light.clear();
  for (ObservedHit& hit : scene.hits) {
    hit.first = static_cast<uint32_t>(scene.wl.size());
    hit.middle = hit.first + static_cast<uint32_t>(terms);
    hit.last = hit.middle + static_cast<uint32_t>(terms);
    for (int i = 0; i < 2 * terms; ++i) {
      scene.wl.push_back(sample_cosine_hemisphere(random.next2()));
      const float sky = 0.2f + 4 * std::pow(std::max(0.0f, dot(scene.wl.back(), direction(0.8f, 1))), 8.0f);
      scene.light.emplace_back(sky / static_cast<float>(terms));
    }
  }
  return scene;
}

ViewWeights views_of(const std::vector<Vec3>& directions) {
  ViewWeights views;
  for (const Vec3& w : directions) add_view(views, w, 1);
  return views;
}

TEST(PairsAround, AreThoseSeenAndTwoRingsMore) {
  const auto bonn = named_directions("81");
  const PairLayout layout(bonn, bonn);
  EXPECT_EQ(pairs_around(layout, views_of(hemisphere_fibonacci(2000))).views.size(), 81u);
  const SeenPairs down = pairs_around(layout, views_of({{0, 0, 1}}));
  EXPECT_EQ(down.views.size(), 1u + 6 + 12);  // rings are 15 degrees apart
  EXPECT_EQ(down.lights.size(), 81u);
  const SeenPairs oblique = pairs_around(layout, views_of({direction(radians_from(45.0f), 1)}));
  EXPECT_LE(oblique.views.size(), 24u);
  EXPECT_GE(oblique.views.size(), 15u);
  EXPECT_EQ(oblique.views[0], 0u);  // its heights make the relief
  for (const uint32_t v : oblique.views) {
    if (v > 0) {
      EXPECT_GT(dot(unit_direction(bonn[v]), direction(radians_from(45.0f), 1)), 0.8f);
    }
  }
  // Where nobody kept the azimuth, all of them.
  SceneDomain domain;
  domain.view[45] = 1;
  EXPECT_GT(pairs_around(layout, domain.directions()).views.size(), 75u);
}

TEST(PairsAround, ViewsOfASideThatNobodySawAreLeftOutAndItsLightsAreNot) {
  const PairLayout layout = test::ringed_layout(true);
  const size_t views = layout.views().size() / 2, lights = layout.lights().size() / 2;
  const Vec3 front(0, 0, 1), back(0, 0, -1);
  const SeenPairs one = pairs_around(layout, views_of({back})), both = pairs_around(layout, views_of({front, back}));
  EXPECT_TRUE(std::ranges::all_of(one.views, [&](uint32_t v) { return v >= views; }));
  EXPECT_EQ(one.lights.size(), 2 * lights);
  EXPECT_EQ(both.views.size(), 2 * one.views.size());
  EXPECT_EQ(both.lights.size(), 2 * lights);
  // A BTF of one side shows it from behind as well.
  EXPECT_EQ(pairs_around(test::ringed_layout(), views_of({back})).views, pairs_around(layout, views_of({front})).views);
}

TEST(SceneBtf, IsMeansOverTexelsOfTheViewsAskedFor) {
  const test::MemoryBtf fine = test::striped_btf({8, 4});
  const auto btf = scene_btf(fine, 1, {{2, 5}, {1, 3, 4}});
  EXPECT_EQ(btf->grid().width, 4u);
  EXPECT_EQ(btf->layout().views(), (std::vector<PolarAngles>{fine.layout().views()[2], fine.layout().views()[5]}));
  const uint64_t light = 3, pair = btf->layout().first(1) + 1;
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
  const auto seen = scene_btf(btf_, 1, pairs_around(btf_.layout(), scene.domain.directions()));
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

/// Two texels by 64 without their finest two levels are one by 16, whose width is reached before its height.
TEST_F(Refit, PicturesOfNarrowTilesAreAsLargeAsTheirTruth) {
  btf_ = test::striped_btf({2, 64});
  const SceneObservation scene = seen_from(20, 4.0 / 32);
  const auto seen = scene_btf(btf_, 2, pairs_around(btf_.layout(), scene.domain.directions()));
  const SeenPictures pictures(*seen, scene, progress_);
  options_.companding = Companding::none;
  EXPECT_LT(pictures.error(full().body, progress_), 1e-3);
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

/// `scene` from behind, or half of it.
SceneObservation turned(SceneObservation scene, size_t every = 1) {
  for (size_t h = 0; h < scene.hits.size(); h += every) scene.hits[h].back = true;
  scene.domain.surface.views = {};
  for (const ObservedHit& hit : scene.hits) {
    add_view(scene.domain.surface.views, {hit.wv.x, hit.wv.y, hit.back ? -hit.wv.z : hit.wv.z}, 1);
  }
  return scene;
}

TEST_F(Refit, OfTwoSidesTheOneThatIsSeenIsEnough) {
  btf_ = test::striped_btf({32, 32}, true);
  const Model full_model = full(), model = reduced(turned(seen_from(20, 4.0 / 32)));
  ASSERT_TRUE(model.scene->seen_views_alone);
  const auto& body = std::get<FactoredBtf>(model.body);
  EXPECT_TRUE(std::ranges::all_of(body.layout.views(), [](const PolarAngles& view) { return view.theta > 90; }));
  EXPECT_LE(8 * body.parameter_bytes(), std::get<FactoredBtf>(full_model.body).parameter_bytes());
  EXPECT_LE(model.scene->picture_error, kMoreError * model.scene->full_picture_error);
  EXPECT_EQ(out_of_views(model.scene->domain, turned(seen_from(20, 4.0 / 32))), 0);
  EXPECT_EQ(out_of_views(model.scene->domain, turned(seen_from(20, 4.0 / 32), 99)), 15.0 / 16);
}

/// `scene` with every other light on the other side.
SceneObservation lit_through(SceneObservation scene) {
  for (size_t i = 0; i < scene.wl.size(); i += 2) scene.wl[i] = mirrored(scene.wl[i]);
  return scene;
}

TEST_F(Refit, LightThatComesThroughIsSeen) {
  btf_ = test::striped_btf({32, 32}, true);
  options_.companding = Companding::none;
  const SceneObservation from_front = lit_through(seen_from(20, 4.0 / 32));
  for (const SceneObservation& scene : {from_front, turned(from_front)}) {
    const auto seen = scene_btf(btf_, 1, pairs_around(btf_.layout(), scene.domain.directions()));
    const SeenPictures pictures(*seen, scene, progress_);
    Model model = full();
    EXPECT_LT(pictures.error(model.body, progress_), 1e-3);
    // The control: a model that shows nothing of it.
    const auto& layout = btf_.layout();
    auto& body = std::get<FactoredBtf>(model.body);
    for (uint64_t pair = 0; pair < layout.pairs(); ++pair) {
      const DirectionPair directions = layout.directions(pair);
      if (directions.wl.z * directions.wv.z > 0) continue;
      std::fill_n(body.pair_value.begin() + static_cast<ptrdiff_t>(pair * body.components()), body.components(),
                  HalfBits{0});
    }
    EXPECT_GT(pictures.error(model.body, progress_), 0.1);
  }
}

TEST_F(Refit, ModelsOfAFrontThatIsSeenLetLightThrough) {
  btf_ = test::striped_btf({32, 32}, true);
  const Model model = reduced(lit_through(seen_from(20, 4.0 / 32)));
  ASSERT_TRUE(model.scene->seen_views_alone);
  EXPECT_TRUE(make_material(std::make_shared<const Model>(model), 0)->transmits());
  EXPECT_LE(model.scene->picture_error, kMoreError * model.scene->full_picture_error);
}

TEST_F(Refit, TwoSidesThatAreSeenAreBothFitted) {
  btf_ = test::striped_btf({32, 32}, true);
  full();
  const Model model = reduced(turned(seen_from(20, 4.0 / 32), 2));
  ASSERT_TRUE(model.scene->seen_views_alone);
  EXPECT_TRUE(has_lower_side(std::get<FactoredBtf>(model.body).layout));
  EXPECT_LE(model.scene->picture_error, kMoreError * model.scene->full_picture_error);
}

TEST_F(Refit, FromOneSideABtfOfOneSideIsKnownFromBoth) {
  const Model model = reduced(turned(seen_from(20, 4.0 / 32)));
  ASSERT_TRUE(model.scene->seen_views_alone);
  EXPECT_EQ(out_of_views(model.scene->domain, seen_from(20, 4.0 / 32)), 0);
}

TEST_F(Refit, AnotherAzimuthIsOutside) {
  SceneObservation scene = seen_from(45, 4.0 / 32), other = scene;
  for (ObservedHit& hit : scene.hits) hit.wv = direction(radians_from(45.0f), 0);
  for (ObservedHit& hit : other.hits) hit.wv = direction(radians_from(45.0f), 2);
  const Model model = reduced(turned(scene));
  ASSERT_TRUE(model.scene->seen_views_alone);
  EXPECT_EQ(out_of_views(model.scene->domain, turned(scene)), 0);
  EXPECT_EQ(out_of_views(model.scene->domain, turned(other)), 1);
}

TEST_F(Refit, AFullModelThatErrsLessIsReducedToNoFewerBytes) {
  struct Case {
    double full_error;
    size_t bytes;
  };
  std::vector<Case> cases;  // of fewer and fewer bytes
  for (const uint64_t bytes : {400000u, 330000u, 270000u, 220000u, 180000u, 150000u, 120000u}) {
    options_.bytes = bytes;
    const Model model = reduced(seen_from(20, 4.0 / 32));
    ASSERT_TRUE(model.scene->seen_views_alone);
    cases.push_back({model.scene->full_picture_error, std::get<FactoredBtf>(model.body).parameter_bytes()});
  }
  int compared = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    for (size_t k = i + 1; k < cases.size(); ++k) {
      if (cases[i].full_error > cases[k].full_error) continue;
      EXPECT_GE(cases[i].bytes, cases[k].bytes) << i << " " << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 10);
}

/// Few terms stand for the light: the product of the errors under both halves is free of what that adds.
TEST_F(Refit, ErrorsOfPicturesDoNotDependOnHowManyTermsStandForTheLight) {
  const Model model = full();
  std::array<double, 2> error{};
  for (const int few : {0, 1}) {
    double sum = 0;
    for (uint64_t seed = 0; seed < 12; ++seed) {
      const SceneObservation lit = lit_at_random(few != 0 ? 24 : 400, seed);
      const auto seen = scene_btf(btf_, 1, pairs_around(btf_.layout(), lit.domain.directions()));
      sum += SeenPictures(*seen, lit, progress_).error(model.body, progress_) / 12;
    }
    error[static_cast<size_t>(few)] = sum;
  }
  EXPECT_NEAR(error[1], error[0], 0.15 * error[0]);
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
}  // namespace velour::scene_refit_test
