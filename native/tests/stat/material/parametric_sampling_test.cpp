// The sampler of parametric models against the density that it claims: all angles of the view, all widths of the
// highlight.
#include "brdf/eval/parametric_material.h"
#include "brdf/eval/parametric_table.h"
#include "math/sphere/random.h"
#include "math/srbf/warped_mixture.h"
#include "support/parametric_models.h"
#include "support/statistics.h"
#include "support/warped_sampler.h"

namespace velour::parametric_sampling_test {
namespace {

using test::LobeRecipe;
using test::Sampler;

/// Cells about the sharpest lobe that the density has at `wv`.
Sampler sampler_of(const ParametricBrdf& brdf, const Vec3& wv) {
  return test::warped_sampler(std::make_shared<ParametricBrdf>(brdf), wv);
}

struct SamplingCase {
  bool isotropic;
  float bandwidth, degrees;
};

void PrintTo(const SamplingCase& c, std::ostream* out) {
  *out << (c.isotropic ? "isotropic" : "anisotropic") << ", bandwidth " << c.bandwidth << ", view " << c.degrees
       << " degrees";
}

std::vector<SamplingCase> sampling_cases() {
  std::vector<SamplingCase> cases;
  for (const float degrees : test::kViewAngles) {
    for (const float b : {1e-4f, 0.1f, 3.0f, 30.0f, 1e3f, 1e5f, 1e6f}) cases.push_back({true, b, degrees});
    for (const float b : {3.0f, 1e3f, 1e6f}) cases.push_back({false, b, degrees});
  }
  return cases;
}

class ParametricSampling : public ::testing::TestWithParam<SamplingCase> {};

TEST_P(ParametricSampling, FollowsItsDensity) {
  const auto [isotropic, bandwidth, degrees] = GetParam();
  const auto brdf = test::parametric_model(isotropic, test::highlight_recipe(bandwidth));
  test::expect_proven(sampler_of(brdf, test::view_at(degrees)), "parametric");
}

INSTANTIATE_TEST_SUITE_P(All, ParametricSampling, ::testing::ValuesIn(sampling_cases()));

// Whose f is that of neither order.
TEST(ParametricSamplingSymmetric, FollowsItsDensity) {
  for (const float bandwidth : {3.0f, 1e3f}) {
    auto brdf = test::parametric_model(true, test::highlight_recipe(bandwidth));
    brdf.symmetric = true;
    for (const float degrees : {20.0f, 75.0f}) {
      test::expect_proven(sampler_of(brdf, test::view_at(degrees)), "symmetric");
    }
  }
}

// Where lobes fade and are left out.
TEST(ParametricSamplingIdle, FollowsItsDensityWithoutIdleLobes) {
  const auto brdf = test::parametric_model(true, test::fading_recipe(30));
  for (const float degrees : {5.0f, 25.0f, 45.0f, 50.0f, 55.0f, 70.0f}) {
    test::expect_proven(sampler_of(brdf, test::view_at(degrees)), "fading");
  }
}

/// One lobe alone, so that nothing hides what it does.
ParametricBrdf lone(LobeSpace space, float bandwidth) {
  return test::parametric_model(true, {{space, bandwidth, Rgb(1), space == LobeSpace::half ? 0 : -0.8f, 0.3f}});
}

TEST(ParametricSamplingControl, ABandwidthOffByFivePercentIsSeen) {
  for (const LobeSpace space : {LobeSpace::light, LobeSpace::half}) {
    for (const float bandwidth : {10.0f, 1e3f, 1e4f}) {  // beyond, the tables' rows are what shows
      const Vec3 wv = test::view_at(50);
      const auto sampler = [&](float b) { return sampler_of(lone(space, b), wv); };
      EXPECT_GT(test::p_value(sampler(bandwidth), sampler(bandwidth)), 1e-4) << bandwidth;
      EXPECT_LT(test::p_value(sampler(bandwidth), sampler(1.05f * bandwidth)), 1e-6) << bandwidth;
    }
  }
}

/// The lobes of a model as they are, drawn from in closed form: draws whose half vector faces away have no direction.
Sampler plain_lobes_of(const ParametricBrdf& brdf, const Vec3& wv) {
  const auto mixture = std::make_shared<WarpedMixture>();
  ParametricValues(brdf).evaluate(wv, ViewPlace(wv), *mixture);
  draw_plain_lobes(*mixture, 0.05f);
  Sampler sampler;
  sampler.sample = [mixture](const Vec2& u) {
    const Vec3 wl = sample_warped(*mixture, u);
    return wl == Vec3(0, 0, -1) ? Vec3(0) : wl;
  };
  sampler.pdf = [mixture](const Vec3& wl) {
    Rgb unused;
    float pdf;
    eval_warped(*mixture, wl, unused, pdf);
    return static_cast<double>(pdf);
  };
  sampler.may_fail = true;
  return sampler;
}

// A lobe of half vectors, seen from the side: many of its draws face away.
TEST(WarpedSamplingControl, DrawsWithoutDirectionAreCounted) {
  Sampler sampler = plain_lobes_of(lone(LobeSpace::half, 20), test::view_at(70));
  auto result = test::chi_square(sampler.sample, sampler.pdf, test::proof_options(sampler));
  EXPECT_GT(result.failed, 0.02 * static_cast<double>(result.options.samples));
  EXPECT_TRUE(test::follows_density(result, 1e-4, "broad"));
  sampler.pdf = [pdf = sampler.pdf](const Vec3& w) { return 1.02 * pdf(w); };
  EXPECT_LT(test::p_value(sampler, sampler), 1e-6);
}

/// Relative variance of f cos / pdf over draws.
double spread(const PreparedBrdf& point, const Sampler& sampler) {
  constexpr uint64_t kSamples = 20'000;
  test::RunningMean mean;
  for (uint64_t i = 0; i < kSamples; ++i) {
    const Vec3 wl = sampler.sample(RandomStream(3, 0, i).next2());
    mean.add(wl.z > 0 ? static_cast<double>(luminance(test::eval_one(point, wl).f) * wl.z) / sampler.pdf(wl) : 0.0);
  }
  return mean.variance() / (mean.mean() * mean.mean());
}

// What the tables of f cos are for: near the horizon most draws of the lobes of f would be wasted.
TEST(ParametricDensity, TablesOfFCosWasteLessThanLobesOfF) {
  const auto brdf = test::parametric_highlight(120, true);
  const auto material = make_parametric_material(brdf);
  for (const float degrees : {60.0f, 75.0f, 85.0f, 89.0f}) {
    const Vec3 wv = test::view_at(degrees);
    ScratchArena arena;
    const PreparedBrdf* const point = material->prepare(wv, arena);
    const double tables = spread(*point, test::material_sampler(material, wv));
    EXPECT_LT(tables, 0.4 * spread(*point, plain_lobes_of(*brdf, wv))) << degrees;
    EXPECT_LT(tables, 0.1) << degrees;
  }
}

// A lobe that no cell of a table would see is drawn from as it is.
TEST(ParametricDensity, NarrowLobesAsideAreDrawn) {
  for (const float bandwidth : {1e4f, 1e6f}) {
    const auto material = make_parametric_material(std::make_shared<ParametricBrdf>(lone(LobeSpace::light, bandwidth)));
    for (const float degrees : {5.0f, 33.0f, 61.0f}) {
      const Vec3 wv = test::view_at(degrees);
      ScratchArena arena;
      const PreparedBrdf* const point = material->prepare(wv, arena);
      EXPECT_LT(spread(*point, test::material_sampler(material, wv)), 1) << bandwidth << ' ' << degrees;
    }
  }
}

}  // namespace
}  // namespace velour::parametric_sampling_test
