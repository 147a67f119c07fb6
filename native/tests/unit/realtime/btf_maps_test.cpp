#include "realtime/maps.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "btf/measure/relief.h"
#include "support/example_srbf.h"

namespace velour::btf_maps_test {
namespace {

/// f at the center of a texel, by what stands in the maps.
Rgb value_in(const BtfMaps& maps, const BtfMaps::Level& level, uint32_t x, uint32_t y, const DirectionPair& pair) {
  const uint32_t rows = maps.maps.height / maps.layers;
  const auto pixel = [&](uint32_t layer) { return maps.maps.at(level.x + x, layer * rows + 1 + y); };
  const float* const relief = pixel(maps.layers - 1);
  const Mat3 turn = to_normal(Vec2(relief[1], relief[2]));
  const LobeArguments at(pair), turned = at.turned(turn);
  Vec3 sum(0.0f);
  for (size_t k = 0; k < maps.terms.size(); ++k) {
    const BtfMaps::Term& term = maps.terms[k];
    const auto value = static_cast<float>(test::lobe_value(term.lobe, term.in_tile ? at : turned));
    sum += pixel(static_cast<uint32_t>(k / 4))[k % 4] * value * term.color;
  }
  return {expanded(Companding::root, sum.x), expanded(Companding::root, sum.y), expanded(Companding::root, sum.z)};
}

/// Expects the maps to have the values of one side of the model at the centers of all texels.
void expect_values(const BtfMaps& maps, const SrbfBtf& btf, const SrbfSide& side) {
  ASSERT_EQ(maps.levels.size(), side.levels.size());
  ASSERT_EQ(maps.terms.size(), side.coefficients());
  const DirectionPair pair{glm::normalize(Vec3(0.3f, -0.4f, 0.8f)), Vec3(0, 0, 1)};  // straight from above: no parallax
  for (size_t i = 0; i < maps.levels.size(); ++i) {
    const BtfMaps::Level& level = maps.levels[i];
    for (uint32_t y = 0; y < level.height; ++y) {
      for (uint32_t x = 0; x < level.width; ++x) {
        const Vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(level.width),
                      (static_cast<float>(y) + 0.5f) / static_cast<float>(level.height));
        const Rgb exact = test::defined_value(btf, side, i, uv, pair), found = value_in(maps, level, x, y, pair);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 1e-4f + 1e-3f * exact[c]);
      }
    }
  }
}

TEST(BtfMaps, HoldWhatTheModelIs) {
  const SrbfBtf btf = test::example_srbf();
  const auto maps = btf_maps(btf);
  ASSERT_EQ(maps.size(), 1u);
  expect_values(maps[0], btf, btf.sides[0]);
}

TEST(BtfMaps, HoldTheSideBelow) {
  const SrbfBtf btf = test::example_srbf(true);
  const auto maps = btf_maps(btf);
  ASSERT_EQ(maps.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const auto number = serving_side(btf, i == 1, i == 1);
    ASSERT_TRUE(number);
    expect_values(maps[i], btf, btf.sides[*number]);
    EXPECT_EQ(maps[i].levels[0].width, maps[0].levels[0].width);
  }
}

TEST(BtfMaps, ASideThatLooksAsTheOtherIsHeldOnce) {
  SrbfBtf btf = test::example_srbf();
  btf.shared.push_back({true, true, 0});
  EXPECT_EQ(btf_maps(btf).size(), 1u);
}

TEST(BtfMaps, BordersRepeatTheTile) {
  const BtfMaps maps = btf_maps(test::example_srbf())[0];
  const uint32_t rows = maps.maps.height / maps.layers;
  for (const BtfMaps::Level& level : maps.levels) {
    for (uint32_t layer = 0; layer < maps.layers; ++layer) {
      const auto at = [&](uint32_t x, uint32_t y) { return maps.maps.at(level.x - 1 + x, layer * rows + y)[0]; };
      for (uint32_t i = 1; i <= level.height; ++i) {
        EXPECT_EQ(at(0, i), at(level.width, i));
        EXPECT_EQ(at(level.width + 1, i), at(1, i));
      }
      EXPECT_EQ(at(0, 0), at(level.width, level.height));
    }
  }
}

TEST(BtfMaps, OneThatIsSeenFromBelowAloneHasNone) {
  SrbfBtf btf = test::example_srbf();
  btf.sides[0].view_below = btf.sides[0].light_below = true;
  EXPECT_THROW(btf_maps(btf), Error);
}

}  // namespace
}  // namespace velour::btf_maps_test
