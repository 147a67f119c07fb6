// The tabulated sampler against the density that it claims.
#include "brdf/eval/per_view_material.h"
#include "brdf/eval/table_sampler.h"
#include "material/principled/principled_material.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/proof_materials.h"
#include "support/statistics.h"

namespace velour::table_sampling_test {
namespace {

using test::Sampler;

constexpr float kTableBandwidths[] = {300, 100, 0, 1e4f};  // of the highlight; 0: a microfacet lobe

std::shared_ptr<const Material> table_material(int kind) {
  if (kind == 1) return test::kLobeMaterials[2].make(kTableBandwidths[kind]);  // not isotropic
  if (kind == 2) return make_principled_material({.metallic = 1, .roughness = 0.4f});
  return test::highlight_material(kTableBandwidths[kind]);
}

Sampler sampler_of(std::shared_ptr<const TableSampler> table, const Vec3& wv) {
  Sampler sampler{
      [table, wv](const Vec2& u) { return test::sample_one(*table, wv, u); },
      [table, wv](const Vec3& wl) { return static_cast<double>(test::pdf_one(*table, {.wl = wl, .wv = wv})); }};
  return sampler;
}

using TableCase = std::tuple<int, float>;

class TableSampling : public ::testing::TestWithParam<TableCase> {
 protected:
  static void SetUpTestSuite() {
    for (int kind = 0; kind < 4; ++kind) tables_.push_back(std::make_shared<TableSampler>(*table_material(kind)));
  }
  static void TearDownTestSuite() { tables_.clear(); }
  static inline std::vector<std::shared_ptr<const TableSampler>> tables_;
};

TEST_P(TableSampling, FollowsItsDensity) {
  const auto [kind, degrees] = GetParam();
  const Vec3 wv = test::view_at(degrees);
  Sampler sampler = sampler_of(tables_[static_cast<size_t>(kind)], wv);
  if (kind != 2) {
    sampler.axis = test::mirror(wv);
    sampler.concentration = kTableBandwidths[kind];
  }
  sampler.refinements = {1, 3};  // the density jumps at every edge of the table, and where a view ends at the horizon
  test::expect_proven(sampler, "table");
}

INSTANTIATE_TEST_SUITE_P(All, TableSampling,
                         ::testing::Combine(::testing::Range(0, 4), ::testing::ValuesIn(test::kViewAngles)));

TEST(TableSamplingControl, AnotherTableIsSeen) {
  const auto table = [](float roughness) {
    const auto material = make_principled_material({.metallic = 1, .roughness = roughness});
    return sampler_of(std::make_shared<TableSampler>(*material), test::view_at(40));
  };
  EXPECT_LT(test::p_value(table(0.5f), table(0.52f)), 1e-6);
}

/// Variance of the estimate of a constant environment, in the same units for each sampler.
TEST(TableSamplingGain, BeatsTheCosineOnAHighlight) {
  const auto material = make_principled_material({.metallic = 1, .roughness = 0.3f});
  const TableSampler table(*material);
  const Vec3 wv = test::view_at(40);
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(wv, arena);
  test::RunningMean by_table, by_cosine;
  for (uint64_t i = 0; i < 20'000; ++i) {
    const Vec2 u = RandomStream(3, 0, i).next2();
    const Vec3 a = test::sample_one(table, wv, u), b = sample_cosine_hemisphere(u);
    by_table.add(a.z > 0 ? test::eval_one(*point, a).f.g * a.z / test::pdf_one(table, {.wl = a, .wv = wv}) : 0);
    by_cosine.add(test::eval_one(*point, b).f.g * kPiD);
  }
  test::ZTests tests;
  tests.add("albedo", by_table.estimate(), by_cosine.estimate());
  EXPECT_TRUE(tests.agree());
  EXPECT_LT(by_table.variance(), 0.02 * by_cosine.variance());
}

}  // namespace
}  // namespace velour::table_sampling_test
