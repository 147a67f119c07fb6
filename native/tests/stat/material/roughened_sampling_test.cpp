// Models with wider lobes are sampled as exactly as any: their samples follow the density that they claim.
#include "math/srbf/kernel.h"
#include "model/model.h"
#include "model/roughened_model.h"
#include "support/parametric_models.h"
#include "support/warped_sampler.h"

namespace velour::roughened_sampling_test {
namespace {

template <typename Body>
std::shared_ptr<const Model> rougher_model(Body body, float roughness) {
  Model model;
  model.body = std::move(body);
  return std::make_shared<const Model>(roughened(model, roughness));
}

std::shared_ptr<const ParametricBrdf> rougher_brdf(ParametricBrdf brdf, float roughness) {
  const auto model = rougher_model(std::move(brdf), roughness);
  return {model, &std::get<ParametricBrdf>(model->body)};
}

struct SamplingCase {
  float bandwidth, roughness, degrees;
};

void PrintTo(const SamplingCase& c, std::ostream* out) {
  *out << "bandwidth " << c.bandwidth << ", roughness " << c.roughness << ", view " << c.degrees << " degrees";
}

std::vector<SamplingCase> sampling_cases() {
  std::vector<SamplingCase> cases;
  for (const float degrees : {0.0f, 30.0f, 60.0f, 85.0f, 89.5f}) {
    for (const float roughness : {0.05f, 0.25f, 0.6f, 1.0f}) {
      for (const float bandwidth : {10.0f, 1e5f}) cases.push_back({bandwidth, roughness, degrees});
    }
  }
  return cases;
}

class RoughenedSampling : public ::testing::TestWithParam<SamplingCase> {};

TEST_P(RoughenedSampling, OfAParametricModelFollowsItsDensity) {
  const auto [bandwidth, roughness, degrees] = GetParam();
  const auto brdf = rougher_brdf(test::parametric_model(true, test::highlight_recipe(bandwidth)), roughness);
  test::expect_proven(test::warped_sampler(brdf, test::view_at(degrees)), "rougher-parametric");
}

TEST_P(RoughenedSampling, OfAPerViewModelFollowsItsDensity) {
  const auto [bandwidth, roughness, degrees] = GetParam();
  const auto model = test::highlight_model(Kernel::gaussian, bandwidth, test::meridian_views(), true);
  const Vec3 wv = test::view_at(degrees);
  test::Sampler sampler = test::material_sampler(make_material(rougher_model(model, roughness), 0), wv);
  sampler.axis = test::mirror(wv);
  sampler.concentration = std::min(static_cast<double>(bandwidth), light_bandwidth_of_roughness(roughness, wv.z));
  test::expect_proven(sampler, "rougher-scattered");
}

INSTANTIATE_TEST_SUITE_P(All, RoughenedSampling, ::testing::ValuesIn(sampling_cases()));

TEST(RoughenedSamplingAnisotropic, FollowsItsDensity) {
  const auto brdf = rougher_brdf(test::parametric_model(false, test::highlight_recipe(1e4f), 6), 0.3f);
  for (const float degrees : {20.0f, 70.0f}) {
    test::expect_proven(test::warped_sampler(brdf, test::view_at(degrees)), "rougher-anisotropic");
  }
}

// What the test would say if samples came from another roughness than the density.
TEST(RoughenedSamplingControl, ARoughnessOffByTwoPercentIsSeen) {
  const auto sampler = [](float roughness) {
    const test::LobeRecipe lone{LobeSpace::half, 1e5f, Rgb(1)};
    return test::warped_sampler(rougher_brdf(test::parametric_model(true, {lone}), roughness), test::view_at(50));
  };
  EXPECT_GT(test::p_value(sampler(0.3f), sampler(0.3f)), 1e-4);
  EXPECT_LT(test::p_value(sampler(0.3f), sampler(0.306f)), 1e-6);
}

}  // namespace
}  // namespace velour::roughened_sampling_test
