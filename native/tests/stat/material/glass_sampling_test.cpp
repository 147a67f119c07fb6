// Samplers of glass, translucency, clear coat and sheen against their densities over the whole sphere.
#include "material/bsdf_materials.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "support/proof_materials.h"

namespace velour::glass_sampling_test {
namespace {

struct Case {
  const char* name;
  std::shared_ptr<const Material> material;
};

GlassParameters glass(float roughness, float index, GlassFresnel fresnel = GlassFresnel::facets) {
  return {.reflected = {0.9f, 0.7f, 0.8f},
          .refracted = {0.5f, 0.8f, 0.9f},
          .roughness = roughness,
          .refraction_roughness = fresnel == GlassFresnel::surface ? 0.5f : roughness,
          .index = index,
          .fresnel = fresnel};
}

std::shared_ptr<const Material> refraction() {
  GlassParameters p = glass(0.6f, 1.3f);
  p.only_refracts = true;
  return make_glass_material(p);
}

/// Half a measured highlight, the rest glass and a translucent sheet.
std::shared_ptr<const Material> mixed() {
  const auto share = [](float value) { return LayerWeight{.factors = {{.value = value}}, .tints = {}}; };
  ShaderLayers layers;
  layers.reflecting.push_back({test::highlight_material(30), share(0.5f)});
  layers.reflecting.push_back({make_glass_material(glass(0.5f, 1.5f)), share(0.3f)});
  layers.reflecting.push_back({make_translucent_material(Rgb(0.4f, 0.6f, 0.2f)), share(0.2f)});
  return make_layered_material(layers);
}

std::shared_ptr<const Material> principled(PrincipledFormula formula) {
  return make_principled_material({.base_color = {0.8f, 0.5f, 0.3f},
                                   .metallic = 0.2f,
                                   .roughness = 0.5f,
                                   .coat = 0.8f,
                                   .coat_roughness = 0.6f,
                                   .transmission = 0.6f,
                                   .transmission_roughness = 0.2f,
                                   .index = 1.4f,
                                   .sheen = 0.7f,
                                   .sheen_roughness = 0.6f,
                                   .formula = formula,
                                   .lobe = formula == PrincipledFormula::disney ? GgxLobe::single : GgxLobe::whole});
}

std::vector<Case> cases() {
  return {{"glass", make_glass_material(glass(0.55f, 1.5f))},
          {"rough glass", make_glass_material(glass(1, 1.5f))},
          {"glass of index below 1", make_glass_material(glass(0.7f, 0.7f))},
          {"glass by the surface's angle", make_glass_material(glass(0.7f, 1.5f, GlassFresnel::surface))},
          {"refraction", refraction()},
          {"translucent", make_translucent_material(Rgb(0.5f))},
          {"principled", principled(PrincipledFormula::layered)},
          {"disney", principled(PrincipledFormula::disney)},
          {"mixed", mixed()}};
}

test::Sampler sampler(std::shared_ptr<const Material> material, float degrees, bool back) {
  test::Sampler of = test::material_sampler(std::move(material), test::view_at(degrees), {.back = back});
  of.may_fail = true;
  return of;
}

/// Case, degrees of the view, and whether it is behind the surface.
class GlassSampling : public testing::TestWithParam<std::tuple<Case, float, bool>> {};

TEST_P(GlassSampling, FollowsItsDensity) {
  const auto& [c, degrees, back] = GetParam();
  test::expect_proven(sampler(c.material, degrees, back), c.name);
}

INSTANTIATE_TEST_SUITE_P(OnBothSides, GlassSampling,
                         testing::Combine(testing::ValuesIn(cases()), testing::Values(0.0f, 40.0f, 80.0f),
                                          testing::Bool()));

TEST(GlassSamplingControls, AreSeen) {
  const auto of = [](float index, float roughness) { return make_glass_material(glass(roughness, index)); };
  EXPECT_LT(test::p_value(sampler(of(1.5f, 0.55f), 40, false), sampler(of(1.5f, 0.55f), 40, true)), 1e-6);
  EXPECT_LT(test::p_value(sampler(of(1.5f, 0.55f), 40, false), sampler(of(1.45f, 0.55f), 40, false)), 1e-6);
  EXPECT_LT(test::p_value(sampler(of(1.5f, 0.55f), 40, false), sampler(of(1.5f, 0.56f), 40, false)), 1e-6);
}

}  // namespace
}  // namespace velour::glass_sampling_test
