#include <gtest/gtest.h>

#include "material/principled/principled_material.h"
#include "support/materials.h"
#include "support/textured_materials.h"

namespace velour::textured_material_test {
namespace {

using test::eval_one;

TEST(TexturedMaterial, IsThePrincipledMaterialOfItsTexels) {
  for (const float roughness : {0.3f, 0.51f, 0.9f}) {
    for (const float metallic : {0.0f, 0.4f, 1.0f}) {
      const PrincipledParameters p{.base_color = {0.2f, 0.5f, 0.9f}, .metallic = metallic, .roughness = roughness};
      const auto found = test::textured(p), exact = make_principled_material(p);
      for (const Vec3& wv : {direction(0.1f, 1), direction(0.9f, 2), direction(1.4f, 4)}) {
        for (const Vec3& wl : hemisphere_fibonacci(25)) {
          const Rgb f = eval_one(*found, {.wl = wl, .wv = wv}).f, e = eval_one(*exact, {.wl = wl, .wv = wv}).f;
          EXPECT_EQ(f, e) << roughness << ' ' << metallic;
        }
      }
    }
  }
}

TEST(TexturedMaterial, VariesOnlyWithATexture) {
  EXPECT_TRUE(test::textured({})->varies());
  EXPECT_FALSE(make_principled_material({})->varies());
}

TEST(TexturedMaterial, AlphaComesFromItsTextureOrValue) {
  EXPECT_EQ(make_principled_material({}, {}, 0.25f)->alpha({}), 0.25f);
  EXPECT_EQ(make_principled_material({}, {.alpha = test::one_texel(0.5f)}, 0.25f)->alpha({}), 0.5f);
  EXPECT_EQ(make_principled_material({}, {.alpha = test::one_texel(7.0f)}, 1)->alpha({}), 1);
  EXPECT_EQ(make_principled_material({})->alpha({}), 1);
}

TEST(TexturedMaterial, MapsTextureCoordinates) {
  // Four texels; turned by a quarter, halved and shifted.
  TextureSlot<float> slot{std::make_shared<const Texture<float>>(2, 2, std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f},
                                                                 TextureOptions{.filter = TextureFilter::closest}),
                          {Mat2(0, 0.5f, -0.5f, 0), {0.5f, 0}}};
  const auto alpha = [&](float u, float v) {
    return make_principled_material({}, {.alpha = slot}, 1)->alpha({.uv = {u, v}});
  };
  EXPECT_EQ(alpha(0.2f, 0.2f), 0.1f);   // to (0.4, 0.1)
  EXPECT_EQ(alpha(0.2f, -0.2f), 0.2f);  // to (0.6, 0.1)
  EXPECT_EQ(alpha(1.2f, 0.2f), 0.3f);   // to (0.4, 0.6)
  EXPECT_EQ(alpha(1.2f, -0.2f), 0.4f);
}

TEST(TexturedMaterial, IsItsMeanWithoutASite) {
  std::vector<Rgb> texels{Rgb(0.1f), Rgb(0.9f), Rgb(0.4f), Rgb(0.2f)};
  const auto material = make_principled_material(
      {.specular = 0}, {.base_color = {std::make_shared<const Texture<Rgb>>(2, 2, texels, TextureOptions{}), {}}}, 1);
  EXPECT_NEAR(eval_one(*material, {.wl = {0, 0, 1}, .wv = direction(0.4f, 1)}).f.g, 0.4f / kPi, 1e-4f);
}

}  // namespace
}  // namespace velour::textured_material_test
