// The sampler of parametric models against the density that it claims: all angles of the view, all widths of the
// highlight. Draws whose half vector faces away from the viewer have no direction; they are a cell of their own.
#include "material/parametric_material.h"
#include "sphere/random.h"
#include "support/parametric_models.h"
#include "support/plain_lobes.h"
#include "support/warped_sampler.h"

namespace velour {
namespace {

using test::LobeRecipe;
using test::Sampler;

/// Cells about the sharpest lobe that the density has at `wv`.
Sampler sampler_of(const ParametricBrdf& brdf, const Vec3& wv) {
  return test::warped_sampler(make_parametric_material(std::make_shared<ParametricBrdf>(brdf)), wv);
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
    for (const float bandwidth : {10.0f, 1e3f, 1e6f}) {
      const Vec3 wv = test::view_at(50);
      const auto sampler = [&](float b) { return sampler_of(lone(space, b), wv); };
      EXPECT_GT(test::p_value(sampler(bandwidth), sampler(bandwidth)), 1e-4) << bandwidth;
      EXPECT_LT(test::p_value(sampler(bandwidth), sampler(1.05f * bandwidth)), 1e-6) << bandwidth;
    }
  }
}

// A lobe of half vectors, seen from the side: many of its draws face away.
TEST(ParametricSamplingControl, DrawsWithoutDirectionAreCounted) {
  Sampler sampler = sampler_of(lone(LobeSpace::half, 20), test::view_at(89));
  auto result = test::chi_square(sampler.sample, sampler.pdf, test::proof_options(sampler));
  EXPECT_GT(result.failed, 0.02 * static_cast<double>(result.options.samples));
  EXPECT_TRUE(test::follows_density(result, 1e-4, "broad"));
  sampler.pdf = [pdf = sampler.pdf](const Vec3& w) { return 1.02 * pdf(w); };
  EXPECT_LT(test::p_value(sampler, sampler), 1e-6);
}

/// Relative variance of f cos / pdf over draws from `point`.
double spread(const Material& material, const PreparedBrdf& point) {
  constexpr uint64_t kSamples = 20'000;
  double sum = 0, sum_sq = 0;
  for (uint64_t i = 0; i < kSamples; ++i) {
    const Vec3 wl = material.sample_one(point, RandomStream(3, 0, i).next2());
    if (wl.z <= 0) continue;
    const auto e = test::eval_one(material, point, wl);
    const double x = static_cast<double>(luminance(e.f) * wl.z / e.pdf);
    sum += x;
    sum_sq += x * x;
  }
  return sum_sq * static_cast<double>(kSamples) / (sum * sum) - 1;
}

// What the fit of the density is for: near the horizon most draws of the lobes of f would be wasted.
TEST(ParametricDensity, LobesOfFCosWasteLessThanLobesOfF) {
  const auto material = make_parametric_material(test::parametric_highlight(120, true));
  for (const float degrees : {60.0f, 75.0f, 85.0f, 89.0f}) {
    PreparedBrdf point;
    material->prepare(test::view_at(degrees), point);
    const double fitted = spread(*material, point);
    test::draw_plain_lobes(point.warped);
    const double plain = spread(*material, point);
    EXPECT_LT(fitted, 0.4 * plain) << degrees;
    EXPECT_LT(fitted, 0.5) << degrees;
  }
}

}  // namespace
}  // namespace velour
