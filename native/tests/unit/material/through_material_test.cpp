#include "material/derived_materials.h"

#include <gtest/gtest.h>

#include "btf/eval/measured_btf_material.h"
#include "math/sphere/frame.h"
#include "model/model.h"
#include "support/striped_btf.h"
#include "support/through_btfs.h"

namespace velour::through_material_test {
namespace {

constexpr uint32_t kWidth = 5, kHeight = 3;

std::shared_ptr<const ThroughMaterial> striped() {
  const auto table = read_btf_table(test::striped_btf({kWidth, kHeight}, true));
  return std::make_shared<const ThroughMaterial>(make_measured_btf_material(table),
                                                 make_measured_btf_material(table, BtfLight::other_side));
}

/// Converts a direction from the viewer's frame to the tile's. `back`: the viewer sees the surface from behind.
Vec3 of_tile(const Vec3& w, bool back) { return back ? mirrored(w) : w; }

/// At texels, and pairs that the BTF has, all four pairs of sides are what it is.
TEST(ThroughMaterial, IsTheBtfUnderLightFromEitherSideSeenFromEitherSide) {
  const auto material = striped();
  const PairLayout layout = test::ringed_layout();
  ScratchArena arena;
  int compared = 0;
  for (uint64_t pair = 0; pair < layout.pairs(); pair += 7) {
    const DirectionPair d = layout.directions(pair);
    const auto x = static_cast<uint32_t>(pair % kWidth), y = static_cast<uint32_t>(pair % kHeight);
    for (const bool back : {false, true}) {
      const SurfaceSite site{.uv = (Vec2(x, y) + 0.5f) / Vec2(kWidth, kHeight), .back = back};
      const PreparedBrdf* const point = material->prepare(d.wv, site, {}, arena);
      for (const Vec3& wl : {d.wl, mirrored(d.wl)}) {
        const Rgb expected = test::striped({of_tile(wl, back), of_tile(d.wv, back)}, x, y);
        const Rgb f = point->eval_one(wl).f;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c], expected[c], 2e-3f * expected[c]);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(ThroughMaterial, ABatchIsWhatOneDirectionAfterTheOtherGives) {
  const auto material = test::through_material<test::SrbfKind>(test::with_through(test::SrbfKind::glossy()));
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(direction(0.7f, 1), {.uv = {0.3f, 0.6f}}, {}, arena);
  std::vector<Vec2> u;
  for (uint32_t i = 0; i < 40; ++i) u.push_back(RandomStream(1, i, 0).next2());
  DirectionBatch wl;
  point->sample(u, wl);
  ASSERT_EQ(wl.count, 40);
  wl.pad();
  RgbBatch f;
  ScalarBatch pdf;
  point->eval(wl, f, pdf);
  int below = 0;
  for (int i = 0; i < wl.count; ++i) {
    EXPECT_EQ(wl.get(i), point->sample_one(u[static_cast<size_t>(i)]));
    const auto one = point->eval_one(wl.get(i));
    EXPECT_NEAR(f.get(i).g, one.f.g, 1e-5f);
    EXPECT_NEAR(pdf.v[i], one.pdf, 1e-4f * one.pdf);
    below += wl.z[i] < 0;
  }
  EXPECT_GT(below, 5);
  EXPECT_LT(below, 35);
}

/// What only the front was seen through is black from behind, not the front's.
TEST(ThroughMaterial, ASideThatIsLeftOutIsBlack) {
  auto btf = test::with_through(test::SrbfKind::glossy());
  btf.sides.pop_back();  // seen from below, lit from above
  const auto material = test::through_material<test::SrbfKind>(btf);
  ScratchArena arena;
  for (const bool back : {false, true}) {
    const PreparedBrdf* const point =
        material->prepare(direction(0.7f, 1), {.uv = {0.3f, 0.6f}, .back = back}, {}, arena);
    EXPECT_EQ(point->eval_one(Vec3(0.6f, 0, -0.8f)).f.g > 0, !back);
    EXPECT_GT(point->eval_one(Vec3(0.6f, 0, 0.8f)).f.g, 0);
  }
}

TEST(ThroughMaterial, ModelsTransmitWhereTheyHaveSuchSides) {
  const auto of = [](auto btf) { return std::make_shared<const Model>(Model{std::move(btf), {}, {}}); };
  EXPECT_FALSE(make_material(of(test::example_srbf()), 0)->transmits());
  EXPECT_FALSE(make_material(of(test::example_srbf(true)), 0)->transmits());
  EXPECT_FALSE(make_material(of(test::example_tensor()), 0)->transmits());
  const auto srbf = of(test::with_through(test::SrbfKind::glossy()));
  EXPECT_TRUE(make_material(srbf, 0)->transmits());
  EXPECT_FALSE(make_reflecting_material(srbf, 0)->transmits());
  EXPECT_TRUE(make_material(of(test::with_through(test::TensorKind::glossy())), 0)->transmits());
}

}  // namespace
}  // namespace velour::through_material_test
