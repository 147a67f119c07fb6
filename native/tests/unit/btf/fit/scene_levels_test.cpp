// Models of BTFs without the levels that scenes do not resolve.
#include "usage/btf/scene_btf.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sphere/directions.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "support/example_tensor.h"
#include "support/sized_srbf.h"
#include "support/striped_btf.h"
#include "usage/btf/scene_reduction.h"

namespace velour::scene_levels_test {
namespace {

/// Look-ups of this share of the tile's side, all over the tile.
SurfaceDomain seen_at(double width) {
  SurfaceDomain domain;
  for (int i = 0; i < 64; ++i) {
    add_seen(domain, static_cast<float>(std::log2(width * 65536)), Vec2(0.0155f * static_cast<float>(i)), 1);
  }
  return domain;
}

uint32_t longest(const ModelBody& body) {
  const Model model{body, {}, {}};
  return std::max(grid_of(model)->width, grid_of(model)->height);
}

/// 16 x 16 texels.
FactoredBtf square_factored() {
  FactoredBtf btf = test::example_factored();
  btf.grid = {16, 16};
  btf.levels.clear();
  for (uint32_t size = 16; size > 0; size /= 2) {
    TexelLevel& level = btf.levels.emplace_back(TexelLevel{size, size, {}});
    std::vector<float> floats(size_t{size} * size * btf.components());
    for (size_t i = 0; i < floats.size(); ++i) floats[i] = 0.4f + 0.3f * std::sin(static_cast<float>(size + i));
    level.value.resize(floats.size());
    floats_to_halves(floats, level.value);
  }
  return btf;
}

TensorBtf square_tensors() {
  TensorBtf btf = test::example_tensor();
  btf.grid = {16, 16};
  btf.sides = {test::random_side(btf.layout, btf.grid, false, {})};
  return btf;
}

std::shared_ptr<const Material> material_of(const ModelBody& body) {
  return make_material(std::make_shared<const Model>(Model{body, {}, {}}), 0);
}

Rgb value(const Material& material, const Vec2& uv, float width, const Vec3& wl, const Vec3& wv) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, {.uv = uv, .footprint = Mat2(width)}, {}, arena);
  return point->eval_one(wl).f;
}

TEST(SceneLevels, LeaveTwoTexelsALookUp) {
  for (const ModelBody& body : {ModelBody(test::example_factored()), ModelBody(test::sized_srbf({16, 16})),
                                ModelBody(test::example_tensor())}) {
    const uint32_t texels = longest(body);
    EXPECT_EQ(unresolved_levels(body, seen_at(2.0 / texels)), 0u) << "two texels are all there are";
    EXPECT_EQ(unresolved_levels(body, seen_at(0.1 / texels)), 0u);
    const ModelBody reduced = without_finest(body, unresolved_levels(body, seen_at(0.999)));
    EXPECT_GE(longest(reduced), 2u);
    EXPECT_LE(longest(reduced), 3u);
  }
}

TEST(SceneLevels, AFarPlaneIsServedByFewerBytes) {
  const SrbfBtf full = test::sized_srbf({64, 64});
  const size_t count = unresolved_levels(full, seen_at(8.0 / 64));
  EXPECT_EQ(count, 2u);
  const auto reduced = std::get<SrbfBtf>(without_finest(full, count));
  EXPECT_GT(full.parameter_bytes(), 12 * reduced.parameter_bytes());
  EXPECT_EQ(reduced.grid.width, 16u);
  EXPECT_EQ(reduced.grid.tile_metres, full.grid.tile_metres);
}

TEST(SceneLevels, KeptLevelsAreLookedUpAsBefore) {
  const Vec3 wl = direction(0.5f, 1), wv = direction(0.7f, 4);
  for (const ModelBody& body :
       {ModelBody(test::sized_srbf({16, 16})), ModelBody(square_factored()), ModelBody(square_tensors())}) {
    const auto full = material_of(body);
    for (const size_t count : {1u, 2u}) {
      const ModelBody reduced = without_finest(body, count);
      const auto kept = material_of(reduced);
      for (const float texels : {1.0f, 1.3f, 2.0f, 3.7f}) {
        const float width = texels / static_cast<float>(longest(reduced));
        for (int i = 0; i < 20; ++i) {
          const Vec2 uv(0.37f * static_cast<float>(i), 0.61f * static_cast<float>(i));
          const Rgb a = value(*full, uv, width, wl, wv), b = value(*kept, uv, width, wl, wv);
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f * (1 + a[c])) << texels << " texels";
        }
      }
    }
  }
}

TEST(SceneLevels, FinerLookUpsDiffer) {  // the control
  const ModelBody body = test::sized_srbf({32, 32});
  const auto full = material_of(body), reduced = material_of(without_finest(body, 1));
  const Vec3 wl = direction(0.5f, 1), wv = direction(0.1f, 4);
  EXPECT_GT(glm::length(value(*full, Vec2(0.3f), 0, wl, wv) - value(*reduced, Vec2(0.3f), 0, wl, wv)), 1e-3f);
}

TEST(SceneLevels, ATileOfUnknownSizeKeepsItsShape) {
  SrbfBtf btf = test::sized_srbf({12, 6});  // 12 x 6, 6 x 3, 3 x 2
  EXPECT_EQ(unresolved_levels(btf, seen_at(0.999)), 2u);
  btf.grid.tile_metres = std::nullopt;
  EXPECT_EQ(unresolved_levels(btf, seen_at(0.999)), 1u);
}

TEST(SceneLevels, AModelOfNoSideIsLeftAlone) {
  SrbfBtf btf = test::sized_srbf({16, 8});
  btf.sides.clear();
  EXPECT_EQ(unresolved_levels(btf, seen_at(0.999)), 0u);
}

class SceneReduction : public ::testing::Test {
 protected:
  SceneReduction() {
    scene_.domain.surface = seen_at(0.999);
    scene_.domain.frames = 1;
    scene_.domain.view[10] = 64;
    scene_.hits.push_back({1, direction(0.1f, 0), 0, 0, 0, 1});
    options_.method = CompressMethod::svd;
    options_.bytes = 60000;
  }
  Model reduced() {
    options_.for_scene = std::make_shared<const SceneObservation>(scene_);
    return compress_for_scene(btf_, options_, progress_);
  }
  std::string refusal() {
    try {
      reduced();
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_argument);
      return error.what();
    }
    return "";
  }

  test::MemoryBtf btf_ = test::striped_btf({16, 16});
  SceneObservation scene_;
  CompressOptions options_;
  Progress progress_;
};

TEST_F(SceneReduction, KeepsItsRecordInItsFile) {
  const Model model = reduced(), back = decode_model(encode_model(model), "small.velour");
  EXPECT_TRUE(is_reduced(back));
  ASSERT_TRUE(back.scene);
  EXPECT_EQ(back.scene->full_texels, (std::array<uint32_t, 2>{16, 16}));
  EXPECT_EQ(grid_of(back)->width, 2u);
  EXPECT_EQ(back.scene->domain.surface.footprint, model.scene->domain.surface.footprint);
  EXPECT_EQ(back.scene->domain.surface.tile, model.scene->domain.surface.tile);
  EXPECT_EQ(encode_model(back), encode_model(model));
  EXPECT_EQ(progress_.fraction(), 1);
}

TEST_F(SceneReduction, TheGivenFullModelIsWhatIsReduced) {
  options_.full_model = std::make_shared<const Model>(compress_btf(btf_, options_, progress_));
  const Model model = reduced();
  const auto &full = std::get<FactoredBtf>(options_.full_model->body), &small = std::get<FactoredBtf>(model.body);
  EXPECT_EQ(small.pair_value, full.pair_value);
  EXPECT_EQ(small.levels.back().value, full.levels.back().value);
  EXPECT_EQ(model.scene->full_parameter_bytes, full.parameter_bytes());
}

TEST_F(SceneReduction, OfTensorsLevelsAreLeftOutAndNoMore) {
  Model full{square_tensors(), {}, {"", "", btf_.provenance().sha256}};
  full.btf = BtfRecord{};
  options_.full_model = std::make_shared<const Model>(full);
  const Model model = reduced();
  const auto &small = std::get<TensorBtf>(model.body), &whole = std::get<TensorBtf>(full.body);
  EXPECT_EQ(small.grid.width, 2u);
  ASSERT_EQ(small.sides.size(), 1u);
  EXPECT_EQ(small.sides[0].clusters.size(), whole.sides[0].clusters.size());
  EXPECT_EQ(small.sides[0].levels[0].value, whole.sides[0].levels[3].value);
  EXPECT_TRUE(is_reduced(model));
  ASSERT_FALSE(model.btf->warnings.empty());
  EXPECT_EQ(model.btf->warnings.back().code, WarningCode::only_finest_levels_left_out);
}

TEST_F(SceneReduction, ASceneThatResolvesAllTexelsGetsTheFullModel) {
  scene_.domain.surface = seen_at(0.5 / 16);
  const Model model = reduced();
  EXPECT_FALSE(is_reduced(model));
  ASSERT_FALSE(model.btf->warnings.empty());
  EXPECT_EQ(model.btf->warnings.back().code, WarningCode::scene_shows_finest_texels);
}

TEST_F(SceneReduction, WhatMakesNoSenseIsRefused) {
  const auto has = [](const std::string& text, const char* word) { return text.find(word) != std::string::npos; };
  const SceneObservation good = scene_;
  scene_.domain.surface = {};
  EXPECT_PRED2(has, refusal(), "does not vary");
  scene_.hits.clear();
  EXPECT_PRED2(has, refusal(), "does not show the material");
  scene_ = good;
  options_.full_model = std::make_shared<const Model>(reduced());
  EXPECT_PRED2(has, refusal(), "itself a scene model");
  Model other = compress_btf(btf_, options_, progress_);
  other.source.sha256 = "another";
  options_.full_model = std::make_shared<const Model>(other);
  EXPECT_PRED2(has, refusal(), "content differs");
  options_.full_model = std::make_shared<const Model>();
  EXPECT_PRED2(has, refusal(), "a BRDF model");
}

}  // namespace
}  // namespace velour::scene_levels_test
