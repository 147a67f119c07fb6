#include "material/factored_material.h"

#include <gtest/gtest.h>

#include <memory>

#include "sphere/directions.h"
#include "support/example_btf.h"
#include "support/simd_targets.h"

namespace velour {
namespace {

struct Evaluator {
  explicit Evaluator(const FactoredBtf& btf)
      : material(make_factored_material(std::make_shared<const FactoredBtf>(btf))) {}
  Rgb operator()(const SurfaceSite& site, const Vec3& wv, const Vec3& wl) {
    material->prepare(wv, site, *point);
    return material->eval_one(*point, wl).f;
  }
  std::shared_ptr<const Material> material;
  std::unique_ptr<PreparedBrdf> point = std::make_unique<PreparedBrdf>();
};

SurfaceSite at(float u, float v, const Mat2& footprint = Mat2(0.0f)) { return {.uv = {u, v}, .footprint = footprint}; }

void expect_same(const Rgb& a, const Rgb& b, float tolerance) {
  EXPECT_NEAR(glm::distance(a, b), 0.0f, tolerance) << a.r << ' ' << a.g << ' ' << a.b << " / " << b.r;
}

TEST(FactoredMaterial, IsTheStoredImageAtTexelsAndPairs) {
  for (const Companding companding : {Companding::none, Companding::root}) {
    const FactoredBtf btf = test::example_factored(false, companding);
    const FactoredImages images(btf);
    std::vector<float> image;
    test::on_every_simd_target([&] {
      Evaluator f(btf);
      for (uint64_t pair = 0; pair < btf.layout.pairs(); ++pair) {
        const DirectionPair d = btf.layout.directions(pair);
        images.image(d, image);
        for (uint32_t y = 0; y < 4; ++y) {
          for (uint32_t x = 0; x < 6; ++x) {
            const float* rgb = image.data() + (y * 6 + x) * 3;
            const SurfaceSite site = at((static_cast<float>(x) + 0.5f) / 6 - 2, (static_cast<float>(y) + 0.5f) / 4 + 5);
            expect_same(f(site, d.wv, d.wl), {rgb[0], rgb[1], rgb[2]}, 2e-5f);
          }
        }
      }
    });
  }
}

TEST(FactoredMaterial, HasNoSeamWhereTheTileRepeats) {
  Evaluator f(test::example_factored());
  const Vec3 wv = direction(0.4f, 0.3f), wl = direction(0.7f, 2.0f);
  const float step = 1e-4f;
  expect_same(f(at(1 - step, 0.4f), wv, wl), f(at(step, 0.4f), wv, wl), 5e-3f);
  expect_same(f(at(0.3f, -step), wv, wl), f(at(0.3f, step), wv, wl), 5e-3f);
  expect_same(f(at(0.3f, 0.4f), wv, wl), f(at(7.3f, -2.6f), wv, wl), 1e-5f);
  // The control: elsewhere in the tile it is something else.
  EXPECT_GT(glm::distance(f(at(0, 0.4f), wv, wl), f(at(0.25f, 0.4f), wv, wl)), 5e-3f);
}

TEST(FactoredMaterial, OfAWideFootprintIsTheCoarsestLevel) {
  FactoredBtf btf = test::example_factored();
  Evaluator f(btf);
  btf.levels[0] = btf.levels.back();
  btf.grid = {1, 1};
  const FactoredImages images(btf);
  std::vector<float> image;
  const DirectionPair d = btf.layout.directions(7);
  images.image(d, image);
  expect_same(f(at(0.1f, 0.9f, Mat2(20.0f)), d.wv, d.wl), {image[0], image[1], image[2]}, 2e-5f);
}

TEST(FactoredMaterial, ShowsItsOtherSideFromBehind) {
  const FactoredBtf btf = test::example_factored(true);
  const FactoredImages images(btf);
  std::vector<float> image;
  Evaluator f(btf);
  const Vec3 wv = direction(0.3f, 0.6f), wl = direction(0.8f, 4.0f);
  images.image({.wl = {wl.x, wl.y, -wl.z}, .wv = {wv.x, wv.y, -wv.z}}, image);
  SurfaceSite site = at(0.5f / 6, 0.5f / 4);
  site.back = true;
  expect_same(f(site, wv, wl), {image[0], image[1], image[2]}, 2e-5f);
  // One that has no other side shows its own.
  Evaluator one(test::example_factored());
  const Rgb behind = one(site, wv, wl);
  site.back = false;
  EXPECT_EQ(behind, one(site, wv, wl));
}

TEST(FactoredMaterial, IsBlackBelowTheHorizonAndNeverNegative) {
  FactoredBtf btf = test::example_factored(false, Companding::none);
  for (HalfBits& h : btf.pair_value) h ^= 0x8000;  // all sums negative
  Evaluator negative(btf), f(test::example_factored());
  for (const Vec3& wl : sphere_fibonacci(200)) {
    EXPECT_EQ(negative(at(0.2f, 0.2f), {0, 0, 1}, wl), Rgb(0.0f));
    if (wl.z > 0) continue;
    EXPECT_EQ(f(at(0.2f, 0.2f), {0, 0, 1}, wl), Rgb(0.0f));
  }
}

}  // namespace
}  // namespace velour
