// Mixed materials and the lobes of single nodes: samples against their density.
#include "brdf/eval/parametric_material.h"
#include "material/bsdf_materials.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "math/sphere/quadrature.h"
#include "math/sphere/random.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/statistics.h"
#include "support/textured_materials.h"
#include "support/through_btfs.h"

namespace velour::shader_layers_sampling_test {
namespace {

LayerWeight by(LayerFactor::Kind kind, float value) { return {{{kind, value}}}; }

std::shared_ptr<const Material> mixed(float share) {
  ShaderLayers layers;
  layers.reflecting = {{make_principled_material({.base_color = {0.7f, 0.2f, 0.1f}, .specular = 0}),
                        by(LayerFactor::Kind::share, share)},
                       {make_glossy_material({.roughness = 0.65f}), by(LayerFactor::Kind::rest, share)},
                       {make_rough_diffuse_material({.roughness = 1}), by(LayerFactor::Kind::gain, 0)},
                       {make_principled_material({.metallic = 1, .roughness = 0.8f}), {}}};
  layers.transparent = {{{0.4f, 0.3f, 0.2f}}};
  return make_layered_material(layers);
}

/// A glossy surface with a normal map, at a place whose relief is turned and tilted.
std::shared_ptr<const Material> tilted() {
  return make_normal_mapped(make_glossy_material({.roughness = 0.6f}), {test::one_texel(Rgb(0.8f, 0.4f, 0.8f)), 1},
                            ReliefPart::lobe);
}

/// Measured reflectance in mixes of mixes: a parametric and a per-view model, a raw measurement, and a BTF that
/// transmits light, beside analytic layers.
std::shared_ptr<const Material> measured_in_mixes(bool transmits) {
  ShaderLayers inner;
  inner.reflecting = {
      {make_parametric_material(test::parametric_highlight(100, true)), by(LayerFactor::Kind::share, 0.4f)},
      {test::measured(test::isotropic_model()), by(LayerFactor::Kind::rest, 0.4f)}};
  inner.reflecting[0].weight.tints = {{{0.9f, 0.5f, 0.1f}}};
  ShaderLayers outer;
  outer.reflecting = {{make_layered_material(inner), by(LayerFactor::Kind::share, 0.7f)},
                      {test::highlight_material(30), by(LayerFactor::Kind::gain, 0.5f)},
                      {tilted(), by(LayerFactor::Kind::rest, 0.7f)}};
  if (transmits) {
    outer.reflecting.push_back({test::through_material<test::SrbfKind>(test::with_through(test::SrbfKind::glossy())),
                                by(LayerFactor::Kind::gain, 2)});
  }
  return make_layered_material(outer);
}

const SurfaceSite kSite{.relief = Mat3({0.9f, 0.3f, 0.1f}, {-0.3f, 0.9f, 0.2f}, {0, 0, 1})};

struct LayersCase {
  const char* name;
  std::shared_ptr<const Material> material;
  float degrees;
};

void PrintTo(const LayersCase& c, std::ostream* out) { *out << c.name << ", view " << c.degrees << " degrees"; }

std::vector<LayersCase> layers_cases() {
  const std::pair<const char*, std::shared_ptr<const Material>> kinds[] = {
      {"glossy", make_glossy_material({.roughness = 0.6f})},
      {"rough diffuse", make_rough_diffuse_material({.roughness = 1})},
      {"mixed", mixed(0.6f)},
      {"normal map", tilted()},
      {"measured", measured_in_mixes(false)},
      {"measured, transmitting", measured_in_mixes(true)},
      {"nothing", make_layered_material({})}};
  std::vector<LayersCase> cases;
  for (const auto& [name, material] : kinds) {
    for (const float degrees : test::kViewAngles) cases.push_back({name, material, degrees});
  }
  return cases;
}

class ShaderLayersSampling : public ::testing::TestWithParam<LayersCase> {};

TEST_P(ShaderLayersSampling, FollowsItsDensity) {
  const auto& [name, material, degrees] = GetParam();
  test::Sampler sampler = test::material_sampler(material, test::view_at(degrees), kSite);
  sampler.may_fail = material->transmits();
  test::expect_proven(sampler, name);
}

INSTANTIATE_TEST_SUITE_P(All, ShaderLayersSampling, ::testing::ValuesIn(layers_cases()));

/// Mean of f |cos| / pdf over samples; `error`, for control, scales the density of those below the horizon.
test::RunningMean albedo_by_sampling(const PreparedBrdf& point, double error) {
  test::RunningMean mean;
  for (uint64_t i = 0; i < 50'000; ++i) {
    const Vec3 wl = point.sample_one(RandomStream(5, 0, i).next2());
    const auto e = point.eval_one(wl);
    const bool nothing = wl == Vec3(0.0f) || !(e.pdf > 0);
    mean.add(nothing ? 0.0 : static_cast<double>(e.f.g * std::abs(wl.z) / e.pdf) / (wl.z < 0 ? error : 1.0));
  }
  return mean;
}

test::Estimate albedo_by_quadrature(const PreparedBrdf& point) {
  const Quadrature z = gauss_legendre(100, 0, 1);
  constexpr int kTurns = 400;
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    const double r = std::sqrt(1 - z.node[i] * z.node[i]);
    for (int k = 0; k < 2 * kTurns; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kTurns, height = k < kTurns ? z.node[i] : -z.node[i];
      const Vec3 wl(r * std::cos(phi), r * std::sin(phi), height);
      sum += z.weight[i] * z.node[i] * static_cast<double>(point.eval_one(wl).f.g);
    }
  }
  const double albedo = sum * 2 * kPiD / kTurns;
  return {albedo, 1e-3 * albedo};  // f of a BTF has creases
}

test::ZTests measured_albedos(double error) {
  const auto material = measured_in_mixes(true);
  test::ZTests tests;
  ScratchArena arena;
  for (const float degrees : {0.0f, 45.0f, 75.0f, 89.0f}) {
    arena.reset();
    const PreparedBrdf* const point = material->prepare(test::view_at(degrees), kSite, {}, arena);
    tests.add(std::to_string(degrees), albedo_by_sampling(*point, error).estimate(), albedo_by_quadrature(*point));
  }
  return tests;
}

TEST(ShaderLayersSampling, MeasuredLayersKeepTheirEnergy) { EXPECT_TRUE(measured_albedos(1).agree()); }

TEST(ShaderLayersSamplingControl, ADensityTooHighBelowIsSeen) { EXPECT_TRUE(measured_albedos(1.2).differ()); }

TEST(ShaderLayersSamplingControl, AnotherShareIsSeen) {
  const auto sampler = [](float share) { return test::material_sampler(mixed(share), test::view_at(45)); };
  EXPECT_GT(test::p_value(sampler(0.6f), sampler(0.6f)), 1e-4);
  EXPECT_LT(test::p_value(sampler(0.6f), sampler(0.8f)), 1e-6);
}

/// The samples of a batch are those of single calls.
TEST(ShaderLayersSampling, ABatchIsItsSamples) {
  const auto material = mixed(0.5f);
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(test::view_at(45), arena);
  std::vector<Vec2> u;
  for (uint64_t i = 0; i < 64; ++i) u.push_back(RandomStream(3, 0, i).next2());
  DirectionBatch wl;
  point->sample(u, wl);
  ASSERT_EQ(wl.count, 64);
  for (size_t i = 0; i < u.size(); ++i) EXPECT_EQ(wl.get(static_cast<int>(i)), point->sample_one(u[i])) << i;
}

}  // namespace
}  // namespace velour::shader_layers_sampling_test
