// Materials mixed of layers: values, what passes, what emits; and the lobes of single nodes.
#include "material/shader_layers.h"

#include <gtest/gtest.h>

#include "material/bsdf_materials.h"
#include "material/derived_materials.h"
#include "material/principled/principled_material.h"
#include "math/sphere/random.h"
#include "support/albedo.h"
#include "support/materials.h"
#include "support/proof_materials.h"
#include "support/textured_materials.h"
#include "support/through_btfs.h"

namespace velour::shader_layers_test {
namespace {

using Kind = LayerFactor::Kind;

std::shared_ptr<const Material> matte(const Rgb& color) {
  return make_principled_material({.base_color = color, .specular = 0});
}

LayerWeight by(Kind kind, float value) { return {{{kind, value}}}; }

/// `share` of red, the rest green.
ShaderLayers two(float share) {
  ShaderLayers layers;
  layers.reflecting = {{matte({1, 0, 0}), by(Kind::share, share)}, {matte({0, 1, 0}), by(Kind::rest, share)}};
  return layers;
}

Rgb f_of(const Material& material, const SurfaceSite& site = {}) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(direction(0.5f, 1), site, {}, arena);
  return test::eval_one(*point, direction(0.7f, 3)).f;
}

void expect_near(const Rgb& found, const Rgb& expected, float error = 1e-5f) {
  EXPECT_LT(glm::distance(found, expected), error) << found.r << ' ' << found.g << ' ' << found.b;
}

TEST(ShaderLayers, AMixIsTheWeightedSum) {
  expect_near(kPi * f_of(*make_layered_material(two(0.3f))), {0.3f, 0.7f, 0});
  expect_near(kPi * f_of(*make_layered_material(two(7))), {1, 0, 0});  // factors of mixes stay in [0, 1]
}

TEST(ShaderLayers, FactorsMultiplyAndVary) {
  ShaderLayers layers = two(0.5f);
  layers.reflecting[0].weight.factors.push_back({.kind = Kind::rest, .texture = test::one_texel(0.2f)});
  layers.reflecting[1].weight.factors.push_back({.kind = Kind::gain, .value = 1.5f});
  const auto material = make_layered_material(layers);
  EXPECT_TRUE(material->varies());
  EXPECT_FALSE(make_layered_material(two(0.5f))->varies());
  expect_near(kPi * f_of(*material), {0.4f, 0.75f, 0});
}

/// What is there is as much brighter as there is less of it.
TEST(ShaderLayers, WhiteMixedInIsAlpha) {
  ShaderLayers layers;
  layers.reflecting = {{matte({1, 0.5f, 0}), by(Kind::share, 0.25f)}};
  layers.transparent = {{Rgb(1), {}, by(Kind::rest, 0.25f)}};
  const auto material = make_layered_material(layers);
  EXPECT_FALSE(material->opaque());
  EXPECT_NEAR(material->alpha({}), 0.25f, 1e-6f);
  EXPECT_EQ(material->passing({}), Rgb(1.0f));
  expect_near(kPi * f_of(*material), {1, 0.5f, 0});
  EXPECT_TRUE(make_layered_material(two(0.5f))->opaque());
  EXPECT_EQ(make_layered_material(two(0.5f))->alpha({}), 1);
}

/// Whatever the layers: alpha f is what they reflect, (1 - alpha) passing what they let through, alpha emission what
/// they send.
TEST(ShaderLayers, SharesMakeUpForTheProbabilityOfMeeting) {
  for (const float amount : {0.0f, 0.2f, 0.6f, 1.0f}) {
    ShaderLayers layers;
    layers.reflecting = {{matte({1, 0.5f, 0}), by(Kind::share, amount)}, {matte({0, 0, 1}), by(Kind::gain, 2)}};
    layers.transparent = {{{0.9f, 0.3f, 0.1f}, {}, by(Kind::rest, amount)}, {{0, 0.2f, 0}}};
    layers.emissive = {{{3, 2, 1}, {}, by(Kind::share, 0.5f)}};
    const auto material = make_layered_material(layers);
    const float alpha = material->alpha({}), rest = 1 - amount;
    EXPECT_GT(alpha, 0);
    EXPECT_LT(alpha, 1);
    expect_near(alpha * kPi * f_of(*material), {amount, 0.5f * amount, 2});
    expect_near((1 - alpha) * material->passing({}), {0.9f * rest, 0.3f * rest + 0.2f, 0.1f * rest});
    expect_near(alpha * material->emission({}), {1.5f, 1, 0.5f});
  }
}

TEST(ShaderLayers, NothingIsBlackAndOpenIsOpen) {
  ScratchArena arena;
  const auto nothing = make_layered_material({});
  EXPECT_EQ(nothing->alpha({}), 1);
  expect_near(f_of(*nothing), Rgb(0));
  const auto open = make_layered_material({.transparent = {{{0.5f, 0.25f, 0}}}});
  EXPECT_EQ(open->alpha({}), 0);
  expect_near(open->passing({}), {0.5f, 0.25f, 0});
  const auto blocked = make_layered_material({.transparent = {{Rgb(0)}}});
  EXPECT_EQ(blocked->alpha({}), 1);
  expect_near(f_of(*blocked), Rgb(0));
}

double albedo(const Material& material, float theta_v) { return test::albedo(material, direction(theta_v, 0)); }

/// A furnace: what is reflected and what passes keep all light, or part of it, but never make any.
TEST(ShaderLayers, AWhiteMixKeepsAllLight) {
  ShaderLayers layers;
  layers.reflecting = {{matte(Rgb(1)), by(Kind::share, 0.3f)}};
  layers.transparent = {{Rgb(1), {}, by(Kind::rest, 0.3f)}};
  const auto material = make_layered_material(layers);
  const float alpha = material->alpha({});
  for (const float theta_v : {0.0f, 0.8f, 1.4f}) {
    const double passes = static_cast<double>((1 - alpha) * material->passing({}).g);
    EXPECT_NEAR(static_cast<double>(alpha) * albedo(*material, theta_v) + passes, 1, 1e-3) << theta_v;
  }
}

/// Mean of f cos / pdf over samples.
double sampled_albedo(const Material& material, float theta_v) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(direction(theta_v, 0), arena);
  double sum = 0;
  constexpr uint64_t kSamples = 100'000;
  for (uint64_t i = 0; i < kSamples; ++i) {
    const Vec3 wl = point->sample_one(RandomStream(1, 0, i).next2());
    const auto found = test::eval_one(*point, wl);
    sum += static_cast<double>(found.f.g * std::max(wl.z, 0.0f) / found.pdf);
  }
  return sum / kSamples;
}

/// Samples that fall below the horizon, and what facets shade from each other, are lost.
TEST(GlossyMaterial, SamplesBringItsAlbedo) {
  double last = 1;
  for (const float roughness : {0.6f, 0.8f, 1.0f}) {
    const auto of = [&](float color) {
      return make_glossy_material({.color = Rgb(color), .roughness = roughness, .lobe = GgxLobe::single});
    };
    const auto white = of(1);
    for (const float theta_v : {0.0f, 0.8f, 1.4f}) {
      const double exact = albedo(*white, theta_v);
      EXPECT_NEAR(sampled_albedo(*white, theta_v), exact, 4e-3) << roughness << ' ' << theta_v;
      EXPECT_NEAR(albedo(*of(0.5f), theta_v), 0.5 * exact, 1e-4);
    }
    EXPECT_LT(albedo(*white, 0), last);
    last = albedo(*white, 0);
  }
}

TEST(GlossyMaterial, FacetsKeepTheLightThatTheySendToEachOther) {
  for (const float roughness : {0.6f, 1.0f}) {
    const auto of = [&](float color) { return make_glossy_material({.color = Rgb(color), .roughness = roughness}); };
    const double white = albedo(*of(1), 0.8f), gray = albedo(*of(0.5f), 0.8f);
    EXPECT_NEAR(white, 1, 5e-3) << roughness;
    EXPECT_LT(gray, 0.49);  // what has met two facets is darker
    EXPECT_GT(gray, albedo(*make_glossy_material({Rgb(0.5f), roughness, GgxLobe::single}), 0.8f) + 0.005);
  }
}

TEST(SingleNodes, ColorsAboveOneAreNotClamped) {
  const Rgb one(0.75f, 0.25f, 0.5f), two = 2.0f * one;
  const auto glossy = [](const Rgb& c) { return make_glossy_material({.color = c, .lobe = GgxLobe::single}); };
  const auto rough = [](const Rgb& c) { return make_rough_diffuse_material({.color = c, .roughness = 0.5f}); };
  const auto disney = [](const Rgb& c) {
    return make_principled_material({.base_color = c, .specular = 0, .formula = PrincipledFormula::disney});
  };
  expect_near(f_of(*glossy(two)), 2.0f * f_of(*glossy(one)));
  expect_near(f_of(*rough(two)), 2.0f * f_of(*rough(one)));
  expect_near(f_of(*matte(two)), 2.0f * f_of(*matte(one)));
  expect_near(f_of(*disney(two)) - f_of(*disney(Rgb(0.0f))), 2.0f * (f_of(*disney(one)) - f_of(*disney(Rgb(0.0f)))));
  // Cycles clamps the reflectance of metals at normal incidence.
  const auto metal = [](const Rgb& c) { return make_principled_material({.base_color = c, .metallic = 1}); };
  expect_near(f_of(*metal(Rgb(2.0f))), f_of(*metal(Rgb(1.0f))));
}

TEST(RoughDiffuseMaterial, IsLambertWithoutRoughnessAndDarkerWithIt) {
  const auto albedo_of = [](float roughness, float theta_v) {
    return albedo(*make_rough_diffuse_material({.color = Rgb(0.8f), .roughness = roughness}), theta_v);
  };
  EXPECT_NEAR(albedo_of(0, 0.7f), 0.8, 1e-4);
  for (const float theta_v : {0.0f, 0.8f, 1.4f}) EXPECT_LT(albedo_of(1, theta_v), 0.8) << theta_v;
  EXPECT_GT(albedo_of(1, 1.4f), albedo_of(1, 0.2f) + 0.01);  // flat: bright at its rim
}

/// A furnace: with light that its facets send to each other, white keeps all of it at every angle, and colors what a
/// series of color per reflection leaves.
TEST(RoughDiffuseMaterial, KeepsItsEnergyByInterreflection) {
  const auto albedo_of = [](float color, bool interreflection, float theta_v) {
    return albedo(*make_rough_diffuse_material({Rgb(color), 1, interreflection}), theta_v);
  };
  const double mean = (kPi + (2 * kPi - 5.6) / 3) / (kPi + kPi / 2 - 2.0 / 3);
  for (const float theta_v : {0.0f, 0.4f, 0.8f, 1.2f, 1.5f}) {
    const double once = albedo_of(1, false, theta_v);
    EXPECT_LT(once, 0.99) << theta_v;
    EXPECT_NEAR(albedo_of(1, true, theta_v), 1, 2e-3) << theta_v;
    const double more = 0.125 * mean * (1 - once) / (1 - 0.5 * (1 - mean));
    EXPECT_NEAR(albedo_of(0.5f, true, theta_v), 0.5 * once + more, 1e-3) << theta_v;
  }
  EXPECT_NEAR(albedo(*make_rough_diffuse_material({Rgb(1), 0, true}), 0.5f), 1, 1e-4);
}

TEST(RoughDiffuseMaterial, NextToNoRoughnessIsNextToLambert) {
  for (const float roughness : {1e-38f, 1e-12f, 1e-8f, 1e-7f, 2e-7f, 1e-5f}) {
    const auto material = make_rough_diffuse_material({Rgb(0.8f), roughness, true});
    for (const float theta_v : {0.0f, 0.7f, 1.5f}) {
      EXPECT_NEAR(albedo(*material, theta_v), 0.8, 1e-4) << roughness << ' ' << theta_v;
    }
  }
}

/// The value of the formula at directions where it is short.
TEST(RoughDiffuseMaterial, FollowsItsFormula) {
  const auto f = [](const Vec3& wl, const Vec3& wv) {
    return test::eval_one(*make_rough_diffuse_material({.color = Rgb(1), .roughness = 1}), {.wl = wl, .wv = wv}).f.g;
  };
  const float a = 1 / (kPi + kPi / 2 - 2.0f / 3);
  EXPECT_NEAR(f({0, 0, 1}, {0, 0, 1}), a, 1e-6f);
  EXPECT_NEAR(f(direction(1, 0), direction(1, 0)), a * (1 + std::sin(1.0f) * std::sin(1.0f) / std::cos(1.0f)), 1e-5f);
  EXPECT_NEAR(f(direction(1, kPi), direction(1, 0)), a * (1 - std::sin(1.0f) * std::sin(1.0f)), 1e-5f);
}

using Btf = test::SrbfKind;

std::shared_ptr<const Material> cloth() {
  static const auto material = test::through_material<Btf>(test::with_through(Btf::example(true)));
  return material;
}

Rgb f_at(const Material& material, const SurfaceSite& site, const Vec3& wv, const Vec3& wl) {
  ScratchArena arena;
  return material.prepare(wv, site, {}, arena)->eval_one(wl).f;
}

/// A measured layer is one among others: weighted, tinted, converted to the working space, on both sides.
TEST(ShaderLayers, MeasuredLayersAreWeightedAndTinted) {
  const Mat3 to_working({0.6f, 0.1f, 0}, {0.3f, 0.8f, 0.1f}, {0.1f, 0.1f, 0.9f});
  const auto tint = test::one_texel(Rgb(0.9f, 0.5f, 0.2f));
  ShaderLayers layers;
  layers.reflecting = {{.material = cloth(), .weight = by(Kind::share, 0.3f), .rec709_colors = true},
                       {.material = matte({1, 0, 0}), .weight = by(Kind::rest, 0.3f)}};
  layers.reflecting[0].weight.tints = {{.texture = tint}, {.color = {0.5f, 1, 1}}};
  layers.rec709_to_working = to_working;
  const auto mix = make_layered_material(layers);
  EXPECT_TRUE(mix->varies());
  EXPECT_TRUE(mix->transmits());
  EXPECT_EQ(mix->texels(), cloth()->texels());
  EXPECT_FALSE(make_layered_material(two(0.5f))->transmits());
  const Vec3 wv = direction(0.5f, 1);
  for (const SurfaceSite& site : {SurfaceSite{.uv = {0.3f, 0.6f}}, SurfaceSite{.uv = {0.7f, 0.1f}, .back = true}}) {
    for (const Vec3& wl : sphere_fibonacci(40)) {
      const Rgb measured = 0.3f * Rgb(0.45f, 0.5f, 0.2f) * (to_working * f_at(*cloth(), site, wv, wl));
      expect_near(f_at(*mix, site, wv, wl), measured + Rgb(wl.z > 0 ? 0.7f / kPi : 0.0f, 0, 0));
    }
  }
}

/// On coarse meshes the view may be below the shading horizon where the normals of other layers are corrected.
TEST(ShaderLayers, LayersWithoutNormalsOfTheirOwnSeeNoViewBelowTheHorizon) {
  ShaderLayers layers;
  layers.reflecting = {
      {.material = test::measured(test::gaussian_highlight(10)), .rec709_colors = true, .lifts_views = true}};
  layers.reflecting[0].top = PrincipledTop{.parameters = {.coat = 1}};
  const auto material = make_layered_material(layers);
  const Vec3 low = glm::normalize(Vec3(0.6f, 0.7f, -0.3f)), lifted = above_horizon(low);
  EXPECT_GT(lifted.z, 0);
  EXPECT_EQ(above_horizon(lifted + Vec3(0, 0, 0.1f)), lifted + Vec3(0, 0, 0.1f));
  ScratchArena arena;
  const PreparedBrdf *const below = material->prepare(low, arena), *const at = material->prepare(lifted, arena);
  Rgb light(0.0f);
  for (const Vec3& wl : hemisphere_fibonacci(40)) {
    const auto found = test::eval_one(*below, wl), expected = test::eval_one(*at, wl);
    EXPECT_EQ(found.f, expected.f);
    EXPECT_EQ(found.pdf, expected.pdf);
    light += found.f;
  }
  EXPECT_GT(light.g, 0);
  EXPECT_EQ(below->sample_one({0.3f, 0.6f}), at->sample_one({0.3f, 0.6f}));
  const Rgb passed = layers.reflecting[0].top->through(low, {}, {});
  EXPECT_TRUE(passed.g >= 0 && passed.g <= 1) << passed.g;
}

TEST(ShaderLayers, TintsAbsorb) {
  ShaderLayers layers;
  layers.reflecting = {{matte(Rgb(1)), by(Kind::share, 0.5f)}};
  layers.transparent = {{Rgb(1), {}, by(Kind::rest, 0.5f)}};
  layers.reflecting[0].weight.tints = {{Rgb(0)}};
  layers.emissive = {{Rgb(2)}};
  layers.emissive[0].weight.tints = {{{1, 0.5f, 0}}};
  const auto material = make_layered_material(layers);
  const float alpha = material->alpha({});
  expect_near(f_of(*material), Rgb(0));
  expect_near(alpha * material->emission({}), {2, 1, 0});
  layers.emissive.clear();
  EXPECT_NEAR(make_layered_material(layers)->alpha({}), 0.5f, 1e-6f) << "what a tint absorbs does not pass";
}

/// Lobes of all layers, or none.
TEST(ShaderLayers, ProposalsAreThoseOfTheLayers) {
  ShaderLayers layers;
  layers.reflecting = {{cloth(), by(Kind::share, 0.5f)}, {cloth(), by(Kind::rest, 0.5f)}};
  ScratchArena arena;
  ProposalLobes lobes;
  EXPECT_FALSE(make_layered_material(layers)->prepare({0, 0, 1}, arena)->proposal_lobes(lobes)) << "of light behind";
  const auto front = Btf::material(Btf::example());
  layers.reflecting = {{front, by(Kind::share, 0.5f)}, {front, by(Kind::gain, 0.25f)}};
  ProposalLobes alone;
  ASSERT_TRUE(make_layered_material(layers)->prepare({0, 0, 1}, arena)->proposal_lobes(lobes));
  ASSERT_TRUE(front->prepare({0, 0, 1}, arena)->proposal_lobes(alone));
  EXPECT_NEAR(lobes.cosine, 0.75f * alone.cosine, 1e-6f);
  EXPECT_EQ(lobes.count, ProposalLobes::kCapacity);
  layers.reflecting.push_back({matte(Rgb(1)), by(Kind::gain, 1)});
  EXPECT_FALSE(make_layered_material(layers)->prepare({0, 0, 1}, arena)->proposal_lobes(lobes));
}

/// A layer with coordinates of its own is what the surface would be whose coordinates are placed like that.
TEST(PlacedMaterial, MovesAndTurnsTheTexture) {
  const auto btf = cloth();
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  const TextureMap map{Mat2({2 * c, -2 * s}, {2 * s, 2 * c}), {0.1f, 0.2f}};  // the texture turns by 0.7
  const auto placed = make_placed(btf, {.map = map});
  const SurfaceSite site{.uv = {0.3f, 0.6f}, .footprint = Mat2(0.05f)};
  const SurfaceSite own{.uv = map.point(site.uv), .footprint = map.map * site.footprint};
  const Mat3 turn({c, s, 0}, {-s, c, 0}, {0, 0, 1});  // from the texture's frame to the surface's
  const Vec3 wv = direction(0.5f, 1);
  for (const Vec3& wl : sphere_fibonacci(20)) {
    expect_near(f_at(*placed, site, turn * wv, turn * wl), f_at(*btf, own, wv, wl));
  }
  const TextureMap mirror{Mat2({-1, 0}, {0, 1}), {0, 0}};
  const auto mirrored = make_placed(btf, {.map = mirror});
  const SurfaceSite across{.uv = mirror.point(site.uv), .footprint = mirror.map * site.footprint};
  for (const Vec3& wl : sphere_fibonacci(20)) {
    const Vec3 flipped(-wl.x, wl.y, wl.z);
    expect_near(f_at(*mirrored, site, {-wv.x, wv.y, wv.z}, flipped), f_at(*btf, across, wv, wl));
  }
  EXPECT_EQ(make_placed(btf, {}), btf);
  const auto plain = matte(Rgb(1));
  EXPECT_EQ(make_placed(plain, {.map = map}), plain);
}

TextureSlot<float> numbers(std::vector<float> values) {
  const auto count = static_cast<int>(values.size());
  return TextureSlot<float>(std::make_shared<const Texture<float>>(count, 1, std::move(values), TextureOptions{}));
}

TEST(MeasuredLayer, TexturesRotateAndScaleTiles) {
  const auto btf = cloth();
  const TextureMap base{Mat2({3, 0}, {0, 3}), {0.1f, 0.2f}};
  const float angle = 0.7f, scale = 2, aspect = 1.5f;
  const auto placed =
      make_placed(btf, {.map = base, .rotation = numbers({angle}), .scale = numbers({scale}), .aspect = aspect});
  EXPECT_TRUE(placed->varies());
  // Tiles of 1.5 x 1 turn as a whole, so their coordinates shear.
  const Mat2 tile({aspect, 0}, {0, 1}), turn({std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)});
  const Mat2 moved = glm::inverse(tile) * glm::inverse(turn) * tile / scale;
  const SurfaceSite site{.uv = {0.3f, 0.6f}, .footprint = Mat2(0.05f)};
  const SurfaceSite own{.uv = moved * base.point(site.uv), .footprint = moved * base.map * site.footprint};
  const auto turned = [&](const Vec3& w) { return Vec3(turn * Vec2(w.x, w.y), w.z); };
  const Vec3 wv = direction(0.5f, 1);
  for (const Vec3& wl : sphere_fibonacci(20)) {
    expect_near(f_at(*placed, site, turned(wv), turned(wl)), f_at(*btf, own, wv, wl));
  }
}

TEST(MeasuredLayer, SharesOfLevelsAddUpToOne) {
  const LayerLevel levels[]{{0, 0, 0.1f}, {0, 0.1f, 0.4f}, {0.1f, 0.4f, 1}, {0.4f, 1, 1}};
  for (const float at : {-1.0f, 0.0f, 0.03f, 0.1f, 0.25f, 0.4f, 0.9f, 1.0f, 2.0f}) {
    float sum = 0;
    for (const LayerLevel& level : levels) sum += level.share(at);
    EXPECT_NEAR(sum, 1, 1e-6f) << at;
  }
  const LayerFactor factor{.kind = LayerFactor::Kind::level, .texture = numbers({0.25f}), .level = levels[1]};
  EXPECT_NEAR(factor.at({}), 0.5f, 1e-6f);
  EXPECT_EQ(levels[1].share(0.4f), 0);
}

}  // namespace
}  // namespace velour::shader_layers_test
