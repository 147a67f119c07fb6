#include <gtest/gtest.h>

#include "material/principled_material.h"
#include "material/principled_table.h"
#include "support/albedo.h"
#include "support/materials.h"
#include "support/textured_materials.h"

namespace velour {
namespace {

using test::eval_one;

/// Largest difference of albedos from those of the table's own integrals, over roughnesses between the nodes.
float table_error(float least, float most, const PrincipledParameters& fixed) {
  const PrincipledTable table(fixed);
  PrincipledLobes found;
  float worst = 0;
  for (float roughness = least; roughness <= most; roughness += 0.0137f) {
    PrincipledParameters p = fixed;
    p.roughness = roughness;
    p.base_color = Rgb(1);
    table.look_up(p, found);
    const PrincipledLobes exact(p);
    for (float cosine = 0.02f; cosine <= 1; cosine += 0.049f) {
      const Vec3 wv(std::sqrt(1 - cosine * cosine), 0, cosine);
      worst = std::max(worst, std::abs(found.base_albedo(found.view(wv)) - exact.base_albedo(exact.view(wv))));
    }
  }
  return worst;
}

TEST(PrincipledTable, IsCloseToTheIntegrals) {
  const float rough = table_error(0.1f, 1, {}), smooth = table_error(0, 0.1f, {});
  const float coated = table_error(0.1f, 1, {.specular = 1, .coat = 0.7f, .coat_roughness = 0.3f});
  RecordProperty("rough", std::to_string(rough));
  RecordProperty("smooth", std::to_string(smooth));
  RecordProperty("coated", std::to_string(coated));
  EXPECT_LT(rough, 1e-3f);
  EXPECT_LT(smooth, 2e-3f);
  EXPECT_LT(coated, 1e-3f);
}

TEST(PrincipledTable, IsExactAtItsEnds) {
  for (const float roughness : {0.0f, 1.0f}) {
    const PrincipledParameters p{
        .base_color = {0.2f, 0.5f, 0.9f}, .metallic = 0.3f, .roughness = roughness, .coat = 0.4f};
    PrincipledLobes found;
    PrincipledTable(p).look_up(p, found);
    const PrincipledLobes exact(p);
    for (const Vec3& wl : hemisphere_fibonacci(15)) {
      const Vec3 wv = direction(0.7f, 0), h = glm::normalize(wl + wv);
      const Rgb expected = exact.value(exact.parts(exact.view(wv), wl, h));
      EXPECT_LT(glm::distance(found.value(found.parts(found.view(wv), wl, h)), expected), 1e-5f * (1 + expected.g));
    }
  }
}

TEST(PrincipledTable, IsSharedByMaterialsOfOneSpecular) {
  const auto table = PrincipledTable::shared({.base_color = Rgb(0.1f), .specular = 0.3f});
  EXPECT_EQ(PrincipledTable::shared({.roughness = 0.9f, .specular = 0.3f}), table);
  EXPECT_NE(PrincipledTable::shared({.specular = 0.4f}), table);
}

TEST(TexturedMaterial, IsThePrincipledMaterialOfItsTexels) {
  for (const float roughness : {0.3f, 0.51f, 0.9f}) {
    for (const float metallic : {0.0f, 0.4f, 1.0f}) {
      const PrincipledParameters p{.base_color = {0.2f, 0.5f, 0.9f}, .metallic = metallic, .roughness = roughness};
      const auto found = test::textured(p), exact = make_principled_material(p);
      for (const Vec3& wv : {direction(0.1f, 1), direction(0.9f, 2), direction(1.4f, 4)}) {
        for (const Vec3& wl : hemisphere_fibonacci(25)) {
          const Rgb f = eval_one(*found, {.wl = wl, .wv = wv}).f, e = eval_one(*exact, {.wl = wl, .wv = wv}).f;
          EXPECT_LT(glm::distance(f, e), 2e-3f * (1 + e.b)) << roughness << ' ' << metallic;
        }
      }
    }
  }
}

TEST(TexturedMaterial, AWhiteBaseReflectsAllLight) {
  for (const float roughness : {0.37f, 0.52f, 0.71f, 0.98f}) {
    const auto material = test::textured({.base_color = Rgb(1), .roughness = roughness});
    for (const float theta_v : {0.0f, 0.8f, 1.3f}) {
      EXPECT_NEAR(test::albedo(*material, direction(theta_v, 0)), 1, 3e-3) << roughness << ' ' << theta_v;
    }
  }
}

TEST(TexturedMaterial, VariesOnlyWithATexture) {
  EXPECT_TRUE(test::textured({})->varies());
  EXPECT_FALSE(make_textured_material({}, {}, 1)->varies());
  EXPECT_FALSE(make_principled_material({})->varies());
}

TEST(TexturedMaterial, AlphaComesFromItsTextureOrValue) {
  EXPECT_EQ(make_textured_material({}, {}, 0.25f)->alpha({}), 0.25f);
  EXPECT_EQ(make_textured_material({}, {.alpha = test::one_texel(0.5f)}, 0.25f)->alpha({}), 0.5f);
  EXPECT_EQ(make_textured_material({}, {.alpha = test::one_texel(7.0f)}, 1)->alpha({}), 1);
  EXPECT_EQ(make_principled_material({})->alpha({}), 1);
}

TEST(TexturedMaterial, MapsTextureCoordinates) {
  // Four texels; turned by a quarter, halved and shifted.
  TextureSlot<float> slot{std::make_shared<const Texture<float>>(2, 2, std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f},
                                                                 TextureOptions{.filter = TextureFilter::closest}),
                          {Mat2(0, 0.5f, -0.5f, 0), {0.5f, 0}}};
  const auto alpha = [&](float u, float v) {
    return make_textured_material({}, {.alpha = slot}, 1)->alpha({.uv = {u, v}});
  };
  EXPECT_EQ(alpha(0.2f, 0.2f), 0.1f);   // to (0.4, 0.1)
  EXPECT_EQ(alpha(0.2f, -0.2f), 0.2f);  // to (0.6, 0.1)
  EXPECT_EQ(alpha(1.2f, 0.2f), 0.3f);   // to (0.4, 0.6)
  EXPECT_EQ(alpha(1.2f, -0.2f), 0.4f);
}

TEST(TexturedMaterial, IsItsMeanWithoutASite) {
  std::vector<Rgb> texels{Rgb(0.1f), Rgb(0.9f), Rgb(0.4f), Rgb(0.2f)};
  const auto material = make_textured_material(
      {.specular = 0}, {.base_color = {std::make_shared<const Texture<Rgb>>(2, 2, texels, TextureOptions{}), {}}}, 1);
  EXPECT_NEAR(eval_one(*material, {.wl = {0, 0, 1}, .wv = direction(0.4f, 1)}).f.g, 0.4f / kPi, 1e-4f);
}

}  // namespace
}  // namespace velour
