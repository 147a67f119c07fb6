#include "btf/eval/measured_btf_material.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/sphere/warp.h"
#include "support/striped_btf.h"

namespace velour::measured_btf_material_test {
namespace {

constexpr uint32_t kWidth = 6, kHeight = 4;

struct Evaluator {
  explicit Evaluator(const BtfMeasurement& btf) : material(make_measured_btf_material(read_btf_table(btf))) {}
  Rgb operator()(const SurfaceSite& site, const Vec3& wv, const Vec3& wl) { return prepared(site, wv).eval_one(wl).f; }
  const PreparedBrdf& prepared(const SurfaceSite& site, const Vec3& wv) {
    arena.reset();
    return *material->prepare(wv, site, {}, arena);
  }
  std::shared_ptr<const Material> material;
  ScratchArena arena;
};

/// The middle of a texel, some tiles away.
SurfaceSite middle_of(uint32_t x, uint32_t y, const Mat2& footprint = Mat2(0.0f)) {
  return {.uv = {(static_cast<float>(x) + 0.5f) / kWidth - 2, (static_cast<float>(y) + 0.5f) / kHeight + 5},
          .footprint = footprint};
}

void expect_same(const Rgb& a, const Rgb& b, float relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * (b[c] + 1e-3f)) << c;
}

TEST(MeasuredBtfMaterial, IsTheTableAtTexelsAndPairs) {
  const test::MemoryBtf btf = test::striped_btf({kWidth, kHeight});
  Evaluator f(btf);
  std::vector<HalfBits> halves(btf.grid().texels() * 3);
  std::vector<float> image(halves.size());
  for (uint64_t pair = 0; pair < btf.layout().pairs(); ++pair) {
    const DirectionPair d = btf.layout().directions(pair);
    btf.read_pairs(pair, 1, halves);
    halves_to_floats(halves, image);
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        const float* rgb = image.data() + (y * kWidth + x) * 3;
        expect_same(f(middle_of(x, y), d.wv, d.wl), {rgb[0], rgb[1], rgb[2]}, 1e-4f);
      }
    }
  }
}

TEST(MeasuredBtfMaterial, IsLinearBetweenTexels) {
  const auto ramp = [](const DirectionPair&, uint32_t x, uint32_t y) {
    return Rgb(static_cast<float>(x), static_cast<float>(y), 1);
  };
  Evaluator f(test::MemoryBtf(test::ringed_layout(), {kWidth, kHeight}, ramp));
  const auto at = [&](float u, float v) { return f({.uv = {u, v}}, direction(0.3f, 1), direction(0.5f, 2)); };
  expect_same(at(2.5f / kWidth, 1.75f / kHeight), {2, 1.25f, 1}, 1e-4f);
  expect_same(at(3.25f / kWidth, 2.5f / kHeight), {2.75f, 2, 1}, 1e-4f);
  expect_same(at(0, 0.5f / kHeight), {2.5f, 0, 1}, 1e-4f);  // across the border: half of the last, half of the first
}

/// A BTF that is 1 for one pair alone shows the weights of its view and its light.
TEST(MeasuredBtfMaterial, IsBarycentricBetweenDirections) {
  const PairLayout layout = test::ringed_layout();
  const PairInterpolation between(layout);
  const Vec3 wv = direction(0.6f, 1), wl = direction(1.1f, 4);
  const auto views = between.view(wv), lights = between.light(wl);
  const DirectionPair d = layout.directions(layout.first(views->index[1]) + lights->index[2]);
  const auto one = [&](const DirectionPair& pair, uint32_t, uint32_t) {
    return Rgb(pair.wv == d.wv && pair.wl == d.wl ? 1.0f : 0.0f);
  };
  Evaluator f(test::MemoryBtf(layout, {kWidth, kHeight}, one));
  const float expected = views->weight[1] * lights->weight[2];
  EXPECT_GT(expected, 0.01f);
  EXPECT_LT(expected, 0.9f);
  expect_same(f(middle_of(1, 1), wv, wl), Rgb(expected), 1e-4f);
}

TEST(MeasuredBtfMaterial, HasNoSeamWhereTheTileRepeats) {
  Evaluator f(test::striped_btf({kWidth, kHeight}));
  const Vec3 wv = direction(0.4f, 0.3f), wl = direction(0.7f, 2.0f);
  const auto at = [&](float u, float v) { return f({.uv = {u, v}}, wv, wl); };
  expect_same(at(1 - 1e-4f, 0.4f), at(1e-4f, 0.4f), 2e-2f);
  expect_same(at(0.3f, -1e-4f), at(0.3f, 1e-4f), 2e-2f);
  expect_same(at(0.3f, 0.4f), at(7.3f, -2.6f), 1e-4f);
  // The control: elsewhere in the tile it is something else.
  EXPECT_GT(std::abs(at(0, 0.4f).g / at(0.25f, 0.4f).g - 1), 0.1f);
}

TEST(MeasuredBtfMaterial, OfAWideFootprintIsTheMeanOfTheTile) {
  const test::MemoryBtf btf = test::striped_btf({kWidth, kHeight});
  Evaluator f(btf);
  for (const uint64_t pair : {3ull, 77ull}) {
    const DirectionPair d = btf.layout().directions(pair);
    Rgb sum(0.0f);
    for (uint32_t t = 0; t < kWidth * kHeight; ++t) sum += f(middle_of(t % kWidth, t / kWidth), d.wv, d.wl);
    expect_same(f(middle_of(1, 2, Mat2(20.0f)), d.wv, d.wl), sum / static_cast<float>(kWidth * kHeight), 1e-3f);
  }
}

TEST(MeasuredBtfMaterial, ShowsItsOtherSideFromBehind) {
  Evaluator f(test::striped_btf({kWidth, kHeight}, true)), one(test::striped_btf({kWidth, kHeight}));
  const PairLayout layout = test::ringed_layout();
  const DirectionPair d = layout.directions(40);
  SurfaceSite site = middle_of(2, 1);
  const Rgb front = f(site, d.wv, d.wl);
  site.back = true;
  const Rgb behind = test::striped({.wl = {d.wl.x, d.wl.y, -d.wl.z}, .wv = {d.wv.x, d.wv.y, -d.wv.z}}, 2, 1);
  expect_same(f(site, d.wv, d.wl), behind, 1e-3f);
  EXPECT_GT(glm::distance(front, behind), 0.05f);
  expect_same(one(site, d.wv, d.wl), front, 1e-4f);  // what has no other side shows its own
}

TEST(MeasuredBtfMaterial, IsBlackBelowTheHorizonAndNeverNegative) {
  const auto negative = [](const DirectionPair&, uint32_t, uint32_t) { return Rgb(-1, 1, -2); };
  Evaluator f(test::MemoryBtf(test::ringed_layout(), {kWidth, kHeight}, negative));
  for (const Vec3& wl : sphere_fibonacci(200)) {
    const Rgb found = f(middle_of(0, 0), {0, 0, 1}, wl);
    EXPECT_EQ(found.r, 0.0f);
    EXPECT_EQ(found.b, 0.0f);
    EXPECT_NEAR(found.g, wl.z > 0 ? 1.0f : 0.0f, 1e-5f);
  }
}

TEST(MeasuredBtfMaterial, SamplesAreThoseOfTheCosine) {
  Evaluator f(test::striped_btf({kWidth, kHeight}));
  const PreparedBrdf& point = f.prepared(middle_of(0, 0), direction(0.8f, 1));
  for (const Vec2& u : {Vec2(0.1f, 0.7f), Vec2(0.9f, 0.2f)}) {
    const Vec3 wl = point.sample_one(u);
    EXPECT_EQ(wl, sample_cosine_hemisphere(u));
    EXPECT_EQ(point.eval_one(wl).pdf, pdf_cosine_hemisphere(wl));
  }
}

}  // namespace
}  // namespace velour::measured_btf_material_test
