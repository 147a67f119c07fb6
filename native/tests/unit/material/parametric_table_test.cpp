#include "brdf/eval/parametric_table.h"

#include <gtest/gtest.h>

#include "brdf/eval/parametric_material.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "math/srbf/warped_mixture.h"
#include "support/materials.h"
#include "support/parametric_models.h"
#include "support/simd_targets.h"

namespace velour::parametric_table_test {
namespace {

using test::LobeRecipe;

/// Parameters that turn as sharply as those of fits do: coefficients and bandwidths that change by e^3 from node to
/// node.
ParametricBrdf restless_model(float bandwidth) {
  ParametricBrdf brdf = test::parametric_model(true, test::highlight_recipe(bandwidth));
  RandomStream random(2, 7, 1);
  for (float& control : brdf.control) control *= 1 + 0.1f * (random.next() - 0.5f);
  return brdf;
}

/// What both evaluators make of a view.
struct Both {
  ParametricValues values;
  ParametricNodes nodes{values};
  ParametricTable table{values, nodes};
  explicit Both(const ParametricBrdf& brdf) : values(brdf) {}

  WarpedMixture exact(const Vec3& wv) const {
    WarpedMixture m;
    values.evaluate(wv, ViewPlace(wv), m);
    return m;
  }
  WarpedMixture tabulated(const Vec3& wv) const {
    WarpedMixture m;
    table.evaluate(wv, m);
    return m;
  }
};

Rgb value_of(const WarpedMixture& m, const Vec3& wl) { return eval_warped(m, wl); }

/// Largest difference of f beyond a millionth of its peak, relative to f.
double largest_error(const Both& both, const Vec3& wv) {
  WarpedMixture exact = both.exact(wv);
  const WarpedMixture tabulated = both.tabulated(wv);
  draw_plain_lobes(exact, 0.05f);
  std::vector<Vec3> lights = hemisphere_fibonacci(100);
  for (int j = 0; j < exact.count; ++j) {
    for (const Vec2& u : {Vec2(0.1f, 0.2f), Vec2(0.5f, 0.7f), Vec2(0.9f, 0.4f)}) {
      const float first = exact.sums[exact.kSums + j - 1], width = exact.sums[exact.kSums + j] - first;
      lights.push_back(sample_warped(exact, {first + u.x * width, u.y}));
    }
  }
  float peak = 0;
  for (const Vec3& wl : lights) peak = std::max(peak, value_of(exact, wl).g);
  double most = 0;
  for (const Vec3& wl : lights) {
    const double f = static_cast<double>(value_of(exact, wl).g), found = static_cast<double>(value_of(tabulated, wl).g);
    most = std::max(most, std::max(std::abs(found - f) - 1e-6 * static_cast<double>(peak), 0.0) / (f + 1e-30));
  }
  return most;
}

TEST(ParametricTable, IsTheModelToAThousandth) {
  test::on_every_simd_target([] {
    for (const float bandwidth : {0.1f, 30.0f, 1e3f, 1e5f}) {
      const Both both(restless_model(bandwidth));
      for (float degrees = 11.6f; degrees < 90; degrees += 0.83f) {
        const Vec3 wv = direction(radians_from(degrees), 0.4f);
        ASSERT_TRUE(both.table.covers(wv));
        EXPECT_LT(largest_error(both, wv), 1e-3) << bandwidth << ' ' << degrees;
      }
    }
  });
}

/// What f of the table lacks, as parametric_table.h measures it.
struct Lost {
  double albedo = 0, norm = 0, value = 0;

  Lost(const WarpedMixture& exact, const WarpedMixture& tabulated) {
    double mass = 0, mass_sq = 0, lost_sq = 0;
    for (const Vec3& wl : hemisphere_fibonacci(500)) {
      const auto f = static_cast<double>(luminance(value_of(exact, wl)));
      const double gap = f - static_cast<double>(luminance(value_of(tabulated, wl))), z = static_cast<double>(wl.z);
      mass += f * z;
      albedo += gap * z;
      mass_sq += f * f * z * z;
      lost_sq += gap * gap * z * z;
      value = std::max(value, gap / f);
    }
    albedo /= mass;
    norm = std::sqrt(lost_sq / mass_sq);
  }
};

TEST(ParametricTable, LobesThatCannotMatterAreLeftOut) {
  const Both both(test::parametric_model(true, test::fading_recipe(30)));
  EXPECT_EQ(both.tabulated(direction(radians_from(20.0f), 1)).listed_count, 6);
  EXPECT_EQ(both.tabulated(direction(radians_from(75.0f), 1)).listed_count, 4);
  double most = 0;
  for (float degrees = 11.6f; degrees < 90; degrees += 0.31f) {
    const Vec3 wv = direction(radians_from(degrees), 0.4f);
    const Lost lost(both.exact(wv), both.tabulated(wv));
    EXPECT_LT(lost.albedo, 1.2 * kIdleAlbedo) << degrees;
    EXPECT_LT(lost.norm, 1.2 * kIdleNorm) << degrees;
    EXPECT_LT(lost.value, 1.2 * kIdleValue) << degrees;
    most = std::max(most, lost.albedo);
  }
  EXPECT_GT(most, 0.1 * kIdleAlbedo);
}

// Lobes that are left out have no value, so batches, which skip them, agree with single directions.
TEST(ParametricTable, LeftOutLobesBringNothing) {
  const Both both(test::parametric_model(true, test::fading_recipe(30)));
  for (float degrees = 11.6f; degrees < 90; degrees += 1.3f) {
    const WarpedMixture m = both.tabulated(direction(radians_from(degrees), 0.4f));
    std::vector<bool> listed(static_cast<size_t>(m.count));
    for (int k = 0; k < m.listed_count; ++k) listed[m.listed[k]] = true;
    for (int j = 0; j < m.count; ++j) {
      if (listed[static_cast<size_t>(j)]) continue;
      EXPECT_EQ(m.r[j] + m.g[j] + m.b[j], 0) << degrees << ' ' << j;
    }
  }
}

TEST(ParametricTable, LeavesOutTheNormalAndAnisotropicModels) {
  EXPECT_FALSE(Both(restless_model(30)).table.covers(direction(radians_from(11.4f), 1)));
  const Both anisotropic(test::parametric_model(false, test::highlight_recipe(30)));
  EXPECT_FALSE(anisotropic.table.covers(direction(1, 1)));
  EXPECT_EQ(anisotropic.table.bytes(), 0u);
}

// The table has 16 lobes; one with 8 lobes takes half as much.
TEST(ParametricTable, FitsTheSecondCache) {
  const std::vector<LobeRecipe> lobes(16, {LobeSpace::light, 3, Rgb(0.01f)});
  EXPECT_LT(Both(test::parametric_model(true, lobes)).table.bytes(), 180'000u);
}

TEST(ParametricTable, SteepCoefficientsStayPositive) {
  ParametricBrdf brdf = test::parametric_model(true, {{LobeSpace::light, 3, Rgb(1)}});
  for (int node = 0; node < brdf.spline().node_count(); ++node) {
    for (const int k : {ParametricBrdf::kLogRed, ParametricBrdf::kLogGreen, ParametricBrdf::kLogBlue}) {
      brdf.control[brdf.index(node, k, 0)] = node % 2 ? -40.0f : 0.0f;
    }
  }
  const Both both(brdf);
  for (float degrees = 11.6f; degrees < 90; degrees += 0.1f) {
    const Rgb f = value_of(both.tabulated(direction(radians_from(degrees), 2)), direction(0.5f, 1));
    EXPECT_TRUE(f.r >= 0 && f.g >= 0 && f.b >= 0) << degrees;
  }
}

/// One direction is what a batch of it is, and of a larger one but for rounding.
TEST(ParametricMaterial, OneDirectionIsABatchOfOne) {
  const auto material = make_parametric_material(test::parametric_highlight(200, true));
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(direction(0.8f, 0.3f), arena);
  RandomStream random(1, 2, 3);
  std::vector<Vec2> u;
  for (int i = 0; i < 64; ++i) u.push_back(random.next2());
  DirectionBatch wl, alone;
  point->sample(u, wl);
  for (int i = 0; i < wl.count; ++i) {
    const Vec3 one = point->sample_one(u[static_cast<size_t>(i)]);
    EXPECT_LT(glm::distance(one, wl.get(i)), 2e-6f);
    point->sample({&u[static_cast<size_t>(i)], 1}, alone);
    EXPECT_EQ(alone.get(0), one);
    alone.pad();
    RgbBatch f;
    ScalarBatch pdf;
    point->eval(alone, f, pdf);
    const auto reflection = point->eval_one(one);
    EXPECT_EQ(reflection.f, f.get(0));
    EXPECT_EQ(reflection.pdf, pdf.v[0]);
  }
}

}  // namespace
}  // namespace velour::parametric_table_test
