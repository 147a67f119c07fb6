// Mixed materials and the lobes of single nodes: samples against their density.
#include "material/glossy_material.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/rough_diffuse_material.h"
#include "material/shader_layers.h"
#include "math/sphere/random.h"
#include "support/proof_materials.h"
#include "support/statistics.h"
#include "support/textured_materials.h"

namespace velour {
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
  test::expect_proven(test::material_sampler(material, test::view_at(degrees), kSite), name);
}

INSTANTIATE_TEST_SUITE_P(All, ShaderLayersSampling, ::testing::ValuesIn(layers_cases()));

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
}  // namespace velour
