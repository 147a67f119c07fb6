// Glass: energy, reciprocity, lobes without width, and what mixes and normal maps make of them.
#include "material/bsdf_materials.h"

#include <gtest/gtest.h>

#include "material/microfacet/ggx.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/materials.h"

namespace velour::glass_material_test {
namespace {

constexpr PrepareOptions kOfPath{.of_path = true};

/// Valid until the next call.
const PreparedBrdf& point_of(const Material& material, const Vec3& wv, bool back = false,
                             const PrepareOptions& options = {}) {
  static ScratchArena arena;
  arena.reset();
  return *material.prepare(wv, {.back = back}, options, arena);
}

GlassParameters glass(float roughness, float index, GgxLobe lobe = GgxLobe::single) {
  return {.roughness = roughness, .refraction_roughness = roughness, .index = index, .lobe = lobe};
}

/// Share of the light that the material returns, by its own samples.
double albedo(const PreparedBrdf& point, uint32_t samples = 40'000) {
  double sum = 0;
  for (uint32_t i = 0; i < samples; ++i) {
    const Vec3 wl = point.sample_one(RandomStream(3, i, 0).next2());
    if (wl == Vec3(0.0f)) continue;
    const auto e = point.eval_one(wl);
    sum += static_cast<double>(e.f.g * std::abs(wl.z) / e.pdf);
  }
  return sum / samples;
}

DeltaLobes deltas_of(const PreparedBrdf& point) {
  DeltaLobes lobes;
  point.delta_lobes(lobes);
  return lobes;
}

TEST(GlassMaterial, SmoothGlassLosesNothing) {
  for (const float index : {1.5f, 0.7f, 1.0f}) {
    const auto material = make_glass_material(glass(0, index));
    for (const float degrees : {0.0f, 30.0f, 60.0f, 88.0f}) {
      for (const bool back : {false, true}) {
        const DeltaLobes lobes = deltas_of(point_of(*material, direction(radians_from(degrees), 1), back, kOfPath));
        EXPECT_EQ(lobes.rest, 0);
        double sum = 0;
        for (int i = 0; i < lobes.count; ++i) sum += static_cast<double>(lobes.lobe[i].weight.g);
        EXPECT_NEAR(sum, 1, 1e-5) << index << ' ' << degrees << ' ' << back;
      }
    }
  }
}

TEST(GlassMaterial, SmoothGlassFollowsSnell) {
  const Vec3 wv = direction(0.6f, 2);
  const DeltaLobes lobes = deltas_of(point_of(*make_glass_material(glass(0, 1.5f)), wv, false, kOfPath));
  ASSERT_EQ(lobes.count, 2);
  EXPECT_LT(glm::distance(lobes.lobe[0].wl, reflected(wv)), 1e-6f);
  const Vec3& through = lobes.lobe[1].wl;
  EXPECT_LT(glm::distance(1.5f * Vec2(through), -Vec2(wv)), 1e-6f);
  EXPECT_LT(through.z, 0);
  EXPECT_NEAR(glm::length(through), 1, 1e-6f);
  EXPECT_NEAR(lobes.lobe[0].weight.g, dielectric_fresnel(wv.z, 1.5f), 1e-6f);
  // Total reflection, seen from inside beyond the critical angle.
  const DeltaLobes inside =
      deltas_of(point_of(*make_glass_material(glass(0, 1.5f)), direction(0.8f, 0), true, kOfPath));
  ASSERT_EQ(inside.count, 1);
  EXPECT_GT(inside.lobe[0].wl.z, 0);
}

TEST(GlassMaterial, WithoutPathsItScatters) {
  const PreparedBrdf& point = point_of(*make_glass_material(glass(0, 1.5f)), direction(0.6f, 2));
  EXPECT_EQ(deltas_of(point).count, 0);
  EXPECT_NEAR(albedo(point), 1, 2e-3);
}

/// At entries of the tables: cosines and roughnesses n / 15, indices whose place is n / 15.
TEST(GlassMaterial, RoughGlassLosesWhatItsTableSays) {
  const float root = 7 / 15.0f, index = (1 + root * root) / (1 - root * root);  // 1.557
  for (const float roughness : {6 / 15.0f, 1.0f}) {
    for (const float cosine : {4 / 15.0f, 12 / 15.0f}) {
      for (const bool back : {false, true}) {
        const Vec3 wv = direction(std::acos(cosine), 0.3f);
        const float eta = back ? 1 / index : index;
        const double expected = static_cast<double>(ggx_albedo::of_glass(roughness, cosine, eta));
        const double single = albedo(point_of(*make_glass_material(glass(roughness, index)), wv, back));
        const auto whole_glass = make_glass_material(glass(roughness, index, GgxLobe::whole));
        const double whole = albedo(point_of(*whole_glass, wv, back));
        EXPECT_NEAR(whole, single / expected, 0.01) << roughness << ' ' << cosine << ' ' << back;
        if (back) {  // the table counts light that leaves the surface on the wrong side, as Blender's does
          EXPECT_LT(single, expected + 6e-3) << roughness << ' ' << cosine;
        } else {
          EXPECT_NEAR(single, expected, 6e-3) << roughness << ' ' << cosine;
        }
      }
    }
  }
  EXPECT_LT(albedo(point_of(*make_glass_material(glass(1, 1.5f)), direction(0.9f, 0))), 0.95);  // the control
}

/// f(wv, wl) = eta^2 f(wl, wv), with the reciprocal index seen from the other side.
TEST(GlassMaterial, IsReciprocalUpToTheSquareOfTheIndex) {
  for (const float index : {1.5f, 0.6f}) {
    const auto material = make_glass_material(glass(0.6f, index));
    int lit = 0;
    for (uint32_t i = 0; i < 200; ++i) {
      RandomStream random(4, i, 0);
      const Vec3 wv = sample_cosine_hemisphere(random.next2()), wl = mirrored(sample_cosine_hemisphere(random.next2()));
      const float there = point_of(*material, wv).eval_one(wl).f.g;
      const float back = point_of(*material, mirrored(wl), true).eval_one(mirrored(wv)).f.g;
      EXPECT_NEAR(there, index * index * back, 5e-4f * (there + 1e-3f)) << i;
      if (there > 1e-3f) {
        EXPECT_GT(std::abs(there - back), 0.1f * there);  // the control
        ++lit;
      }
      const Vec3 above = mirrored(wl);
      const float reflected = point_of(*material, wv).eval_one(above).f.g;
      EXPECT_NEAR(reflected, point_of(*material, above).eval_one(wv).f.g, 5e-4f * (reflected + 1e-3f));
    }
    EXPECT_GT(lit, 30);
  }
}

/// Cycles evaluates refraction where no facet could refract, but samples nothing there.
TEST(GlassMaterial, OnlyPathsSeeRefractionWithoutFacets) {
  const auto material = make_glass_material(glass(0.8f, 1.5f));
  const Vec3 wv = direction(radians_from(70.0f), 0);
  const Vec3 wl = mirrored(direction(radians_from(85.0f), 0.5f));  // |wl.z| < wv.z / 1.5: the half vector points down
  EXPECT_EQ(point_of(*material, wv).eval_one(wl).f, Rgb(0.0f));
  EXPECT_EQ(point_of(*material, wv).eval_one(wl).pdf, 0);
  EXPECT_GT(point_of(*material, wv, false, kOfPath).eval_one(wl).f.g, 0);
  const Vec3 usual = mirrored(direction(radians_from(40.0f), kPi));
  EXPECT_EQ(point_of(*material, wv, false, kOfPath).eval_one(usual).f, point_of(*material, wv).eval_one(usual).f);
}

TEST(GlassMaterial, MixesKeepLobesWithoutWidth) {
  ShaderLayers layers;
  const auto share = [](float value) { return LayerWeight{.factors = {{.value = value}}, .tints = {}}; };
  layers.reflecting.push_back({make_glass_material(glass(0, 1.5f)), share(0.5f)});
  layers.reflecting.push_back({make_glass_material(glass(0, 1.8f)), share(0.25f)});
  layers.reflecting.push_back({make_translucent_material(Rgb(0.8f)), share(0.25f)});
  const auto material = make_layered_material(layers);
  EXPECT_TRUE(material->transmits());
  const Vec3 wv = direction(0.6f, 2);
  const PreparedBrdf& point = point_of(*material, wv, false, kOfPath);
  const DeltaLobes lobes = deltas_of(point);
  ASSERT_EQ(lobes.count, 3);  // both reflect in one direction
  EXPECT_NEAR(lobes.lobe[0].weight.g, 0.5f * dielectric_fresnel(wv.z, 1.5f) + 0.25f * dielectric_fresnel(wv.z, 1.8f),
              1e-6f);
  double sum = 0;
  for (int i = 0; i < lobes.count; ++i) sum += static_cast<double>(lobes.lobe[i].weight.g);
  EXPECT_NEAR(sum, 0.75, 1e-5);
  EXPECT_NEAR(lobes.rest, 0.2, 0.02);
  // What scatters is the translucent layer alone.
  for (uint32_t i = 0; i < 100; ++i) EXPECT_LT(point.sample_one(RandomStream(1, i, 0).next2()).z, 0);
  EXPECT_NEAR(point.eval_one(mirrored(wv)).pdf, wv.z / kPi, 1e-6f);
  EXPECT_NEAR(point.eval_one(mirrored(wv)).f.g, 0.25f * 0.8f / kPi, 1e-6f);
}

TEST(GlassMaterial, FullLobesJoinTheNearest) {
  DeltaLobes lobes;
  for (int i = 0; i < 6; ++i) lobes.add(direction(0.3f + 0.2f * static_cast<float>(i), 0), Rgb(0.1f));
  EXPECT_EQ(lobes.count, DeltaLobes::kCapacity);
  float sum = 0;
  for (int i = 0; i < lobes.count; ++i) sum += lobes.lobe[i].weight.g;
  EXPECT_NEAR(sum, 0.6f, 1e-6f);
}

TEST(GlassMaterial, FilterRoughensAndLeavesOutReflection) {
  const auto material = make_glass_material(glass(0, 1.5f));
  const Vec3 wv = direction(0.6f, 2);
  const PreparedBrdf& rough = point_of(*material, wv, false, {.of_path = true, .filter = {.min_alpha = 0.3f}});
  EXPECT_EQ(deltas_of(rough).count, 0);
  EXPECT_GT(rough.eval_one(Vec3(0, 0, -1)).f.g, 0);
  const DeltaLobes through =
      deltas_of(point_of(*material, wv, false, {.of_path = true, .filter = {.diffuse_only = true}}));
  ASSERT_EQ(through.count, 1);
  EXPECT_LT(through.lobe[0].wl.z, 0);
}

TEST(GlassMaterial, PrincipledHasItsShareOfGlass) {
  const PrincipledParameters p{.base_color = {0.25f, 0.49f, 1}, .metallic = 0.5f, .roughness = 0, .transmission = 0.5f};
  const Vec3 wv = direction(0.6f, 2);
  const DeltaLobes lobes = deltas_of(point_of(*make_principled_material(p), wv, false, kOfPath));
  ASSERT_EQ(lobes.count, 2);
  const float fresnel = dielectric_fresnel(wv.z, 1.5f);
  EXPECT_LT(glm::distance(lobes.lobe[0].weight, Rgb(0.25f * fresnel)), 1e-5f);
  EXPECT_LT(glm::distance(lobes.lobe[1].weight, 0.25f * (1 - fresnel) * Rgb(0.5f, 0.7f, 1)), 1e-5f);
  EXPECT_GT(lobes.rest, 0.1f);
  EXPECT_FALSE(make_principled_material({})->transmits());
}

/// The light that sheen and coat let through and the light that they reflect add up to at most all of it.
TEST(GlassMaterial, WhiteUnderSheenAndCoatLosesLittle) {
  for (const float cosine : {0.2f, 0.6f, 1.0f}) {
    const auto material = make_principled_material({.base_color = Rgb(1), .coat = 1, .sheen = 1});
    EXPECT_NEAR(albedo(point_of(*material, direction(std::acos(cosine), 1))), 1, 0.03) << cosine;
  }
}

TEST(SheenLobe, MatchesItsAlbedo) {
  for (const float roughness : {0.3f, 1.0f}) {
    const auto material = make_principled_material(
        {.base_color = Rgb(0), .specular = 0, .sheen = 1, .sheen_roughness = roughness, .sheen_tint = Rgb(1)});
    const Vec3 wv = direction(1.2f, 0.4f);
    EXPECT_NEAR(albedo(point_of(*material, wv)), static_cast<double>(SheenLobe(roughness, wv.z).albedo), 2e-3);
  }
  EXPECT_GT(SheenLobe(0.3f, 0.1f).albedo, 5 * SheenLobe(0.3f, 0.9f).albedo);
}

}  // namespace
}  // namespace velour::glass_material_test
