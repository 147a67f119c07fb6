#include "btf/model/srbf_evaluator.h"

#include <gtest/gtest.h>

#include <memory>

#include "math/sphere/directions.h"
#include "support/example_srbf.h"
#include "support/simd_targets.h"
#include "unit/btf/measure/random_pair.h"

namespace velour::srbf_evaluator_test {
namespace {

using test::random_pair;

std::shared_ptr<const SrbfBtf> shared(SrbfBtf btf) { return std::make_shared<const SrbfBtf>(std::move(btf)); }

Rgb value_at(const SrbfEvaluator& evaluator, uint32_t side, const Vec2& uv, float level, const DirectionPair& pair) {
  const auto point = std::make_unique<SrbfPoint>();
  evaluator.begin(side, pair.wv, *point);
  evaluator.add(uv, level, 1, *point);
  evaluator.finish(*point);
  return evaluator.value(*point, pair.wl);
}

TEST(ToNormal, IsTheShortestRotationThatTakesTheNormalUp) {
  for (const Vec3& normal : hemisphere_fibonacci(100)) {
    const Mat3 turn = to_normal(Vec2(normal) / normal.z);
    EXPECT_NEAR(glm::distance(turn * normal, Vec3(0, 0, 1)), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::determinant(turn), 1.0f, 1e-5f);
    const Mat3 identity = turn * glm::transpose(turn);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(identity[i / 3][i % 3], i % 4 == 0 ? 1.0f : 0.0f, 1e-5f);
    // The axis lies in the plane and stays, so the turn is by no more than the tilt.
    const Vec3 axis(normal.y, -normal.x, 0);
    EXPECT_NEAR(glm::distance(turn * axis, axis), 0.0f, 1e-5f);
  }
  EXPECT_EQ(to_normal(Vec2(0.0f)), Mat3(1.0f));
}

TEST(SrbfEvaluator, IsTheDefinition) {
  for (const Companding companding : {Companding::none, Companding::root}) {
    const SrbfBtf btf = test::example_srbf(true, companding);
    const SrbfEvaluator evaluator(shared(btf));
    test::on_every_simd_target([&] {
      for (uint64_t i = 0; i < 200; ++i) {
        RandomStream random(12, i, 0);
        const Vec2 uv = random.next2();
        const auto level = static_cast<size_t>(random.next() * 3);
        const auto side = static_cast<uint32_t>(random.next() * 2);
        const DirectionPair pair = random_pair(i);
        const Rgb found = value_at(evaluator, side, uv, static_cast<float>(level), pair);
        const Rgb expected = test::defined_value(btf, btf.sides[side], level, uv, pair);
        EXPECT_NEAR(glm::distance(found, expected), 0.0f, 1e-4f) << i;  // slopes are rounded to sixteen bits
      }
    });
  }
}

/// Bytes span what each coefficient takes on all levels.
TEST(SrbfSide, RoundsItsValuesToTheNearestOf256) {
  SrbfSide side = test::example_side(6, 4, false);
  const size_t count = side.coefficients();
  std::vector<std::vector<float>> values;
  RandomStream random(15, 0, 0);
  for (const SrbfLevel& level : side.levels) {
    auto& of_level = values.emplace_back(level.value.size());
    for (size_t i = 0; i < of_level.size(); ++i) of_level[i] = static_cast<float>(i % count) * (random.next() - 0.4f);
  }
  side.set_scale(values);
  side.set_values(values);
  for (size_t l = 0; l < values.size(); ++l) {
    for (size_t i = 0; i < values[l].size(); ++i) {
      const ByteScale& scale = side.scale[i % count];
      const float stored = scale.least + scale.step * side.levels[l].value[i];
      EXPECT_NEAR(stored, values[l][i], 0.501f * scale.step + 1e-7f);
      EXPECT_LE(scale.step, static_cast<float>(i % count) / 255 * 1.0001f);
    }
  }
  EXPECT_EQ(side.scale[0].step, 0.0f);  // of a coefficient that is the same everywhere
}

TEST(SrbfEvaluator, KnowsItsSides) {
  const SrbfEvaluator one(shared(test::example_srbf())), two(shared(test::example_srbf(true)));
  EXPECT_EQ(one.side(false, false), 0u);
  EXPECT_EQ(one.side(true, true), std::nullopt);
  EXPECT_EQ(two.side(true, true), 1u);
  EXPECT_EQ(two.side(true, false), std::nullopt);
}

TEST(SrbfEvaluator, PlacesAddByTheirWeights) {
  const SrbfEvaluator evaluator(shared(test::example_srbf(false, Companding::none)));
  const DirectionPair pair = random_pair(3);
  const Vec2 a(0.2f, 0.3f), b(0.25f, 0.35f);
  const auto point = std::make_unique<SrbfPoint>();
  evaluator.begin(0, pair.wv, *point);
  evaluator.add(a, 0, 0.75f, *point);
  evaluator.add(b, 0, 0.25f, *point);
  evaluator.finish(*point);
  // Normals are blended before lobes are: near, not equal.
  const Rgb mixed = 0.75f * value_at(evaluator, 0, a, 0, pair) + 0.25f * value_at(evaluator, 0, b, 0, pair);
  EXPECT_NEAR(glm::distance(evaluator.value(*point, pair.wl), mixed), 0.0f, 0.01f);
}

TEST(SrbfEvaluator, LevelsBeyondTheLastAreTheLast) {
  const SrbfEvaluator evaluator(shared(test::example_srbf()));
  const DirectionPair pair = random_pair(5);
  EXPECT_EQ(value_at(evaluator, 0, {0.1f, 0.1f}, 9, pair), value_at(evaluator, 0, {0.1f, 0.1f}, 2, pair));
  EXPECT_EQ(value_at(evaluator, 0, {0.1f, 0.1f}, -1, pair), value_at(evaluator, 0, {0.1f, 0.1f}, 0, pair));
}

TEST(SrbfEvaluator, ImagesHaveTheSideOfTheirPair) {
  const SrbfBtf btf = test::example_srbf(true);
  const SrbfEvaluator evaluator(shared(btf));
  const DirectionPair up = random_pair(8), down{-up.wl, -up.wv};
  std::vector<float> rgb;
  for (const DirectionPair& pair : {up, down}) {
    srbf_image(evaluator, pair, rgb);
    const DirectionPair at{{pair.wl.x, pair.wl.y, std::abs(pair.wl.z)}, {pair.wv.x, pair.wv.y, std::abs(pair.wv.z)}};
    const uint32_t side = pair.wv.z < 0 ? 1 : 0;
    for (uint32_t t = 0; t < 24; ++t) {
      const Vec2 uv((static_cast<float>(t % 6) + 0.5f) / 6, (static_cast<float>(t / 6) + 0.5f) / 4);
      const Rgb expected = test::defined_value(btf, btf.sides[side], 0, uv, at);
      EXPECT_NEAR(glm::distance(Rgb(rgb[3 * t], rgb[3 * t + 1], rgb[3 * t + 2]), expected), 0.0f, 1e-3f);
    }
  }
  srbf_image(evaluator, {up.wl, down.wv}, rgb);
  for (const float f : rgb) EXPECT_EQ(f, 0.0f);
}

TEST(SrbfEvaluator, IsFiniteAtTheHorizonAndForOppositeDirections) {
  const SrbfEvaluator evaluator(shared(test::example_srbf()));
  const float z = 1e-4f;
  const Vec3 grazing(std::sqrt(1 - z * z), 0, z), opposite(-grazing.x, 0, 0);
  for (const Vec3& wv : {grazing, Vec3(0, 0, 1)}) {
    for (const Vec3& wl : {grazing, -grazing, opposite, Vec3(0, 0, 1)}) {
      const Rgb f = value_at(evaluator, 0, {0.3f, 0.3f}, 0, {wl, wv});
      EXPECT_TRUE(std::isfinite(f.r + f.g + f.b));
      EXPECT_GE(std::min({f.r, f.g, f.b}), 0.0f);
    }
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Rgb f = value_at(evaluator, 0, {nan, 0.3f}, 0, random_pair(1));
  EXPECT_TRUE(std::isfinite(f.r + f.g + f.b));
}

}  // namespace
}  // namespace velour::srbf_evaluator_test
