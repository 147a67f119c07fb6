// Materials of BTFs that are made of sides, whatever their kind.
#include <gtest/gtest.h>

#include <memory>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/sided_btfs.h"
#include "support/simd_targets.h"

namespace velour::sided_btf_material_test {
namespace {

struct Evaluator {
  explicit Evaluator(std::shared_ptr<const Material> m) : material(std::move(m)) {}
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

template <typename Kind>
class SidedBtfMaterial : public ::testing::Test {
 protected:
  using Btf = typename Kind::Btf;
  static Evaluator evaluator(const Btf& btf) { return Evaluator(Kind::material(btf)); }
};
TYPED_TEST_SUITE(SidedBtfMaterial, test::SidedBtfKinds, test::SidedBtfNames);

TYPED_TEST(SidedBtfMaterial, IsTheDefinitionEverywhere) {
  for (const Companding companding : {Companding::none, Companding::root}) {
    const auto btf = TypeParam::example(false, companding);
    test::on_every_simd_target([&] {
      Evaluator f = this->evaluator(btf);
      for (uint64_t i = 0; i < 100; ++i) {
        RandomStream random(15, i, 0);
        const Vec2 uv = random.next2();
        const Vec3 wl = direction(1.5f * random.next(), 2 * kPi * random.next());
        const Vec3 wv = direction(1.4f * random.next(), 2 * kPi * random.next());
        const Rgb expected = test::defined_value(btf, btf.sides[0], 0, uv, {wl, wv});
        expect_same(f(at(uv.x - 2, uv.y + 5), wv, wl), expected, TypeParam::kTolerance);
      }
    });
  }
}

TYPED_TEST(SidedBtfMaterial, HasNoSeamWhereTheTileRepeats) {
  Evaluator f = this->evaluator(TypeParam::example());
  const Vec3 wv = direction(0.2f, 0.3f), wl = direction(0.7f, 2.0f);
  const float step = 1e-4f;
  expect_same(f(at(1 - step, 0.4f), wv, wl), f(at(step, 0.4f), wv, wl), 5e-3f);
  expect_same(f(at(0.3f, -step), wv, wl), f(at(0.3f, step), wv, wl), 5e-3f);
  expect_same(f(at(0.3f, 0.4f), wv, wl), f(at(7.3f, -2.6f), wv, wl), 1e-4f);
  // The control: elsewhere in the tile it is something else.
  EXPECT_GT(glm::distance(f(at(0, 0.4f), wv, wl), f(at(0.25f, 0.4f), wv, wl)), 5e-3f);
}

TYPED_TEST(SidedBtfMaterial, OfAWideFootprintIsTheCoarsestLevel) {
  const auto btf = TypeParam::example();
  Evaluator f = this->evaluator(btf);
  const Vec3 wv = direction(0.4f, 0.3f), wl = direction(0.7f, 2.0f);
  const Rgb expected = test::defined_value(btf, btf.sides[0], 2, {0.1f, 0.9f}, {wl, wv});
  expect_same(f(at(0.1f, 0.9f, Mat2(20.0f)), wv, wl), expected, TypeParam::kTolerance);
}

TYPED_TEST(SidedBtfMaterial, ShowsItsOtherSideFromBehind) {
  const auto btf = TypeParam::example(true);
  Evaluator f = this->evaluator(btf), one = this->evaluator(TypeParam::example());
  const Vec3 wv = direction(0.3f, 0.6f), wl = direction(0.8f, 4.0f);
  SurfaceSite site = at(0.5f / 6, 0.5f / 4);
  const Rgb front = f(site, wv, wl);
  site.back = true;
  expect_same(f(site, wv, wl), test::defined_value(btf, btf.sides[1], 0, site.uv, {wl, wv}), TypeParam::kTolerance);
  EXPECT_GT(glm::distance(front, f(site, wv, wl)), 1e-2f);
  EXPECT_EQ(one(site, wv, wl), front);  // one that has no other side shows its own
}

TYPED_TEST(SidedBtfMaterial, IsBlackBelowTheHorizonAndNeverNegative) {
  auto btf = TypeParam::example(false, Companding::none);
  btf.axes = Mat3(1.0f);
  TypeParam::negate(btf);  // all sums
  Evaluator negative = this->evaluator(btf), f = this->evaluator(TypeParam::example());
  for (const Vec3& wl : sphere_fibonacci(200)) {
    EXPECT_EQ(negative(at(0.2f, 0.2f), {0, 0, 1}, wl), Rgb(0.0f));
    if (wl.z > 0) continue;
    EXPECT_EQ(f(at(0.2f, 0.2f), {0, 0, 1}, wl), Rgb(0.0f));
  }
}

TYPED_TEST(SidedBtfMaterial, IsFiniteAtTheHorizon) {
  Evaluator f = this->evaluator(TypeParam::example());
  for (const float z : {1e-2f, 1e-4f}) {
    const Vec3 w(std::sqrt(1 - z * z), 0, z);
    for (const Vec3& wl : {w, Vec3(-w.x, 0, z), Vec3(0, 0, 1)}) {
      const Rgb value = f(at(0.2f, 0.7f), w, wl);
      EXPECT_TRUE(std::isfinite(value.r + value.g + value.b));
    }
  }
}

// Lobes also draw from below the horizon, where nothing is seen: the density above it holds what is drawn there.
TYPED_TEST(SidedBtfMaterial, DensitiesIntegrateToTheShareDrawnAbove) {
  Evaluator f = this->evaluator(TypeParam::example());
  constexpr uint64_t kDirections = 20000;
  for (const float theta : {0.0f, 0.9f, 1.4f}) {
    const PreparedBrdf& point = f.prepared(at(0.3f, 0.6f), direction(theta, 1));
    double sum = 0;
    for (const Vec3& wl : hemisphere_fibonacci(kDirections)) {
      sum += static_cast<double>(point.eval_one(wl).pdf);
    }
    double above = 0;
    for (uint64_t i = 0; i < kDirections; ++i) {
      const Vec3 wl = point.sample_one(RandomStream(16, i, 0).next2());
      EXPECT_NEAR(glm::length(wl), 1.0f, 1e-4f);
      if (!(wl.z > 0)) continue;
      ++above;
      EXPECT_GT(point.eval_one(wl).pdf, 0.0f);
    }
    const double share = above / kDirections;
    EXPECT_GT(share, 0.9) << "hardly anything is drawn in vain";
    EXPECT_NEAR(sum * 2 * kPiD / kDirections, share, 1e-3 + 4 * std::sqrt(share * (1 - share) / kDirections)) << theta;
  }
}

}  // namespace
}  // namespace velour::sided_btf_material_test
