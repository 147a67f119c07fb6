// Textured Principled materials: samples against their density, and against the albedo.
#include "support/proof_materials.h"
#include "support/statistics.h"
#include "support/textured_materials.h"

namespace velour {
namespace {

struct TexturedCase {
  const char* name;
  PrincipledParameters parameters;
  float degrees;
};

void PrintTo(const TexturedCase& c, std::ostream* out) { *out << c.name << ", view " << c.degrees << " degrees"; }

std::vector<TexturedCase> textured_cases() {
  const std::pair<const char*, PrincipledParameters> kinds[] = {
      {"textured plastic", {.base_color = {0.2f, 0.5f, 0.8f}, .roughness = 0.63f}},
      {"textured metal", {.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 1, .roughness = 0.77f}},
      {"textured coat",
       {.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 0.4f, .roughness = 0.9f, .coat = 0.8f, .coat_roughness = 0.6f}}};
  std::vector<TexturedCase> cases;
  for (const auto& [name, parameters] : kinds) {
    for (const float degrees : test::kViewAngles) cases.push_back({name, parameters, degrees});
  }
  return cases;
}

class TexturedSampling : public ::testing::TestWithParam<TexturedCase> {};

TEST_P(TexturedSampling, FollowsItsDensity) {
  const auto& [name, parameters, degrees] = GetParam();
  test::expect_proven(test::material_sampler(test::textured(parameters), test::view_at(degrees)), name);
}

INSTANTIATE_TEST_SUITE_P(All, TexturedSampling, ::testing::ValuesIn(textured_cases()));

TEST(TexturedSamplingControl, AnotherRoughnessIsSeen) {
  const auto sampler = [](float roughness) {
    return test::material_sampler(test::textured({.metallic = 1, .roughness = roughness}), test::view_at(45));
  };
  EXPECT_GT(test::p_value(sampler(0.7f), sampler(0.7f)), 1e-4);
  EXPECT_LT(test::p_value(sampler(0.7f), sampler(0.72f)), 1e-6);
}

}  // namespace
}  // namespace velour
