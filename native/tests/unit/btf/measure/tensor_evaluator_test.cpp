#include "btf/model/tensor_evaluator.h"

#include <gtest/gtest.h>

#include <memory>

#include "math/sphere/directions.h"
#include "support/example_tensor.h"
#include "support/simd_targets.h"
#include "unit/btf/measure/random_pair.h"

namespace velour::tensor_evaluator_test {
namespace {

using test::random_pair;

std::shared_ptr<const TensorBtf> shared(TensorBtf btf) { return std::make_shared<const TensorBtf>(std::move(btf)); }

Rgb value_at(const TensorEvaluator& evaluator, uint32_t side, const Vec2& uv, float level, const DirectionPair& pair) {
  const auto point = std::make_unique<TensorPoint>();
  evaluator.begin(side, pair.wv, *point);
  evaluator.add(uv, level, 1, *point);
  evaluator.finish(*point);
  return evaluator.value(*point, pair.wl);
}

void expect_same(const Rgb& a, const Rgb& b, float tolerance, uint64_t i) {
  EXPECT_NEAR(glm::distance(a, b), 0.0f, tolerance) << i << ": " << a.r << ' ' << a.g << ' ' << a.b << " / " << b.r;
}

TensorTables tables(const TensorBtf& btf, uint64_t most_bytes) {
  return TensorContraction(btf, btf.sides[0], most_bytes).tables();
}

/// Size of the first side's tables in the order of pairs.
uint64_t bytes_of_pairs(const TensorBtf& btf) {
  const TensorTables t = tables(btf, TensorEvaluator::kMaxTableBytes);
  return directions_on_side(btf.layout.views(), false).size() * t.lights * t.light_node() * sizeof(float);
}

void expect_defined(const TensorBtf& btf, uint64_t most_bytes) {
  const TensorEvaluator evaluator(shared(btf), most_bytes);
  test::on_every_simd_target([&] {
    for (uint64_t i = 0; i < 200; ++i) {
      RandomStream random(12, i, 0);
      const Vec2 uv = random.next2();
      const auto level = static_cast<size_t>(random.next() * 3);
      const auto side = static_cast<uint32_t>(random.next() * static_cast<float>(btf.sides.size()));
      const DirectionPair pair = random_pair(i);
      const Rgb found = value_at(evaluator, side, uv, static_cast<float>(level), pair);
      expect_same(found, test::defined_value(btf, btf.sides[side], level, uv, pair), 2e-5f, i);
    }
  });
}

/// In every order: where there is room, in less than pairs take, and with none.
void expect_defined(const TensorBtf& btf) {
  for (const uint64_t most : {TensorEvaluator::kMaxTableBytes, bytes_of_pairs(btf) - 1, uint64_t{0}}) {
    expect_defined(btf, most);
  }
}

TEST(TensorContraction, IsAsEarlyAsThereIsRoomFor) {
  const TensorBtf btf = test::example_tensor(false, Companding::root, {3, 1, {1, 2, 3, 1}, false});
  const uint64_t pairs = bytes_of_pairs(btf);
  EXPECT_EQ(tables(btf, pairs).order, TensorOrder::pairs);
  EXPECT_EQ(tables(btf, pairs - 1).order, TensorOrder::views);
  EXPECT_EQ(tables(btf, 0).order, TensorOrder::ranks);
}

TEST(TensorContraction, SaysWhatItTakes) {
  const TensorBtf btf = test::example_tensor(false, Companding::root, {3, 1, {1, 2, 3, 1}, false});
  const auto bytes = [&](uint64_t most) { return TensorContraction::bytes(btf, btf.sides[0], most); };
  const uint64_t pairs = bytes_of_pairs(btf);
  EXPECT_EQ(bytes(pairs), pairs);
  EXPECT_LT(bytes(pairs - 1), pairs);
  EXPECT_GT(bytes(0), 0u);
}

TEST(TensorContraction, IsNotOfPairsWherePointsHaveNoRoomForTheirRows) {
  const test::TensorShape shape{128, 2, {16, 2, 2, 3}, false};  // 128 x 48 numbers are more than 4096
  EXPECT_EQ(tables(test::example_tensor(false, Companding::root, shape), uint64_t{1} << 40).order, TensorOrder::views);
}

TEST(TensorEvaluator, IsTheDefinition) {
  for (const Companding companding : {Companding::none, Companding::root}) {
    expect_defined(test::example_tensor(true, companding));
  }
}

TEST(TensorEvaluator, OfAllShapesIsTheDefinition) {
  expect_defined(test::example_tensor(false, Companding::root, {1, 1, {1, 1, 1, 1}, false}));
  expect_defined(test::example_tensor(false, Companding::root, {1, 1, {33, 3, 17, 3}, true}));  // Tucker
  expect_defined(test::example_tensor(false, Companding::root, {5, 1, {16, 6, 16, 1}, false}));
  expect_defined(test::example_tensor(false, Companding::root, {256, 8, {2, 2, 2, 1}, true}));
  expect_defined(test::example_tensor(false, Companding::root, {2, 2, {17, 3, 2, 3}, true}));  // rows of 51
}

TEST(TensorImages, HaveTheSideOfTheirPair) {
  const TensorBtf btf = test::example_tensor(true);
  const TensorImages images(btf);
  const DirectionPair up = random_pair(8), down{-up.wl, -up.wv};
  std::vector<float> rgb;
  for (const DirectionPair& pair : {up, down}) {
    images.image(pair, rgb);
    const DirectionPair at{{pair.wl.x, pair.wl.y, std::abs(pair.wl.z)}, {pair.wv.x, pair.wv.y, std::abs(pair.wv.z)}};
    const TensorSide& side = btf.sides[pair.wv.z < 0 ? 1 : 0];
    for (uint32_t t = 0; t < 24; ++t) {
      const Vec2 uv((static_cast<float>(t % 6) + 0.5f) / 6, (static_cast<float>(t / 6) + 0.5f) / 4);
      expect_same({rgb[3 * t], rgb[3 * t + 1], rgb[3 * t + 2]}, test::defined_value(btf, side, 0, uv, at), 2e-5f, t);
    }
  }
  images.image({up.wl, down.wv}, rgb);
  for (const float f : rgb) EXPECT_EQ(f, 0.0f);
}

TEST(TensorImages, OfASharedSideAreThoseOfTheOneThatServesIt) {
  TensorBtf btf = test::example_tensor();
  btf.shared = {{true, true, 0}};
  const DirectionPair up = random_pair(9);
  std::vector<float> above, below;
  TensorImages(btf).image(up, above);
  TensorImages(btf).image({{up.wl.x, up.wl.y, -up.wl.z}, {up.wv.x, up.wv.y, -up.wv.z}}, below);
  EXPECT_EQ(above, below);
}

}  // namespace
}  // namespace velour::tensor_evaluator_test
