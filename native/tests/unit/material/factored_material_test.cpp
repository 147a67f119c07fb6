#include "btf/eval/factored_material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "math/sphere/directions.h"
#include "support/example_btf.h"
#include "support/simd_targets.h"

namespace velour::factored_material_test {
namespace {

struct Evaluator {
  explicit Evaluator(const FactoredBtf& btf)
      : material(make_factored_material(std::make_shared<const FactoredBtf>(btf))) {}
  Rgb operator()(const SurfaceSite& site, const Vec3& wv, const Vec3& wl) { return prepared(site, wv).eval_one(wl).f; }
  const PreparedBrdf& prepared(const SurfaceSite& site, const Vec3& wv) {
    arena.reset();
    return *material->prepare(wv, site, {}, arena);
  }
  std::shared_ptr<const Material> material;
  ScratchArena arena;
};

SurfaceSite at(float u, float v, const Mat2& footprint = Mat2(0.0f)) { return {.uv = {u, v}, .footprint = footprint}; }

void expect_same(const Rgb& a, const Rgb& b, float tolerance) {
  EXPECT_NEAR(glm::distance(a, b), 0.0f, tolerance) << a.r << ' ' << a.g << ' ' << a.b << " / " << b.r;
}

TEST(FactoredMaterial, IsTheStoredImageAtTexelsAndPairs) {
  for (const auto& [companding, by_view] :
       {std::pair(Companding::none, false), {Companding::root, false}, {Companding::root, true}}) {
    const FactoredBtf btf = test::example_factored(false, companding, by_view);
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

/// Components that serve a view, as components of all pairs that are 0 at other views.
FactoredBtf of_all_views(const FactoredBtf& of_views) {
  FactoredBtf btf = of_views;
  const size_t components = btf.components();
  btf.view.clear();
  btf.pair_value.assign(btf.layout.pairs() * components, 0);
  std::vector<size_t> order(components);
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return btf.axis[a] < btf.axis[b]; });
  for (size_t k = 0; k < components; ++k) {
    const size_t from = order[k];
    btf.axis[k] = of_views.axis[from];
    for (size_t l = 0; l < btf.layout.lights().size(); ++l) {
      btf.pair_value[(btf.layout.first(of_views.view[from]) + l) * components + k] =
          of_views.pair_value[l * components + from];
    }
    for (size_t level = 0; level < btf.levels.size(); ++level) {
      for (size_t t = 0; t < btf.levels[level].value.size(); t += components) {
        btf.levels[level].value[t + k] = of_views.levels[level].value[t + from];
      }
    }
  }
  return btf;
}

TEST(FactoredMaterial, OfViewsIsThatOfAllPairsWithZerosElsewhere) {
  for (const bool two_sided : {false, true}) {
    const FactoredBtf of_views = test::example_factored(two_sided, Companding::root, true);
    Evaluator f(of_views), g(of_all_views(of_views));
    float largest = 0;
    for (const Vec3& wv : sphere_fibonacci(60)) {
      if (wv.z <= 0.05f) continue;
      for (const Vec3& wl : {Vec3(0, 0, 1), direction(0.9f, 1.0f), direction(1.3f, 4.0f)}) {
        SurfaceSite site = at(0.3f + wv.x, 0.7f * wv.y, Mat2(0.3f * wv.z));
        site.back = wv.y > 0;
        expect_same(f(site, wv, wl), g(site, wv, wl), 2e-5f);
        largest = std::max(largest, f(site, wv, wl).r);
      }
    }
    EXPECT_GT(largest, 0.05f);
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
}  // namespace velour::factored_material_test
