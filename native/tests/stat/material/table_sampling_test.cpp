#include "judge.h"
#include "material/principled_material.h"
#include "material/scattered_material.h"
#include "material/table_sampler.h"
#include "sphere/random.h"
#include "sphere/warp.h"
#include "support/materials.h"
#include "support/statistics.h"

namespace velour {
namespace {

test::ChiSquareResult judge_table(const TableSampler& sampled, const TableSampler& claimed, const Vec3& wv,
                                  uint64_t seed) {
  test::ChiSquareOptions options = test::quick_options(seed);
  options.refinements = 3;  // the density jumps at every edge of the table
  return test::chi_square([&](const Vec2& u) { return sampled.sample(wv, u); },
                          [&](const Vec3& wl) { return test::pdf_one(claimed, {.wl = wl, .wv = wv}); }, options);
}

std::shared_ptr<const Material> scattered(const ScatteredBrdf& brdf) {
  return make_scattered_material(std::make_shared<ScatteredBrdf>(brdf), 0);
}

TEST(TableSampling, FollowsItsDensity) {
  const double level = test::sidak_level(0.01, 12);
  const std::shared_ptr<const Material> materials[] = {scattered(test::isotropic_model()),
                                                       scattered(test::anisotropic_model()),
                                                       make_principled_material({.metallic = 1, .roughness = 0.4f})};
  uint64_t seed = 0;
  for (const auto& material : materials) {
    const TableSampler table(*material);
    for (const Vec3& wv : test::judged_views()) {
      ++seed;
      test::expect_accepted(judge_table(table, table, wv, seed), level,
                            std::to_string(seed) + " at cosine " + std::to_string(wv.z));
    }
  }
}

TEST(TableSampling, RejectsAnotherTable) {
  const TableSampler table(*make_principled_material({.metallic = 1, .roughness = 0.5f}));
  const TableSampler other(*make_principled_material({.metallic = 1, .roughness = 0.52f}));
  EXPECT_LT(judge_table(table, other, direction(0.7f, 0.4f), 1).p_value, 1e-6);
}

/// Variance of the estimate of a constant environment, in the same units for each sampler.
TEST(TableSampling, BeatsTheCosineOnAHighlight) {
  const auto material = make_principled_material({.metallic = 1, .roughness = 0.3f});
  const TableSampler table(*material);
  const Vec3 wv = direction(0.7f, 0.4f);
  PreparedBrdf point;
  material->prepare(wv, point);
  test::RunningMean by_table, by_cosine;
  for (uint64_t i = 0; i < 20'000; ++i) {
    const Vec2 u = RandomStream(3, 0, i).next2();
    const Vec3 a = table.sample(wv, u), b = sample_cosine_hemisphere(u);
    by_table.add(a.z > 0 ? test::eval_one(*material, point, a).f.g * a.z / test::pdf_one(table, {.wl = a, .wv = wv})
                         : 0);
    by_cosine.add(test::eval_one(*material, point, b).f.g * kPiD);
  }
  EXPECT_GT(test::z_test(by_table.mean(), by_table.standard_error(), by_cosine.mean(), by_cosine.standard_error()),
            0.005);
  EXPECT_LT(by_table.variance(), 0.02 * by_cosine.variance());
}

}  // namespace
}  // namespace velour
