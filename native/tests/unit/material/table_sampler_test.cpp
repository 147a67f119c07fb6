#include "brdf/eval/table_sampler.h"

#include <gtest/gtest.h>

#include "brdf/eval/per_view_material.h"
#include "material/principled/principled_material.h"
#include "support/materials.h"

namespace velour::table_sampler_test {
namespace {

TEST(TableSampler, IsPositiveAboveTheHorizonAndFinite) {
  const auto material = make_principled_material({Rgb(0.5f), 1, 0.2f, 0.5f});
  const TableSampler table(*material);
  for (const Vec3& wv : {Vec3(0, 0, 1), direction(0.7f, 2), direction(1.5707f, -1)}) {
    for (const Vec3& wl : sphere_fibonacci(300)) {
      const float pdf = test::pdf_one(table, {wl, wv});
      EXPECT_TRUE(std::isfinite(pdf));
      EXPECT_GE(pdf, 0);
      if (wl.z > 0) {
        EXPECT_GT(pdf, 0);
      }
    }
    EXPECT_TRUE(std::isfinite(test::pdf_one(table, {-wv, wv})));
    EXPECT_TRUE(std::isfinite(test::pdf_one(table, {wv, wv})));
  }
}

TEST(TableSampler, SurvivesABlackMaterial) {
  const TableSampler table(*make_principled_material({.base_color = Rgb(0), .metallic = 0, .specular = 0}));
  for (const Vec2& u : {Vec2(0, 0), Vec2(0.5f), Vec2(1 - 0x1p-24f)}) {
    const Vec3 wl = test::sample_one(table, direction(1, 1), u);
    EXPECT_NEAR(glm::length(wl), 1, 1e-5f);
    EXPECT_GE(test::pdf_one(table, {wl, direction(1, 1)}), 0);
  }
}

// Where the table is fine enough its density is the normalized f cos.
TEST(TableSampler, ResolvesASharpHighlight) {
  const auto material = make_principled_material({Rgb(1), 1, 0.1f, 0.5f});  // highlight of about half a degree
  const TableSampler table(*material);
  const Vec3 wv = direction(0.7f, 0.3f), wl = test::mirror(wv);
  const float f_cos = test::eval_one(*material, {wl, wv}).f.g * wl.z;
  EXPECT_NEAR(test::pdf_one(table, {wl, wv}) / f_cos, 0.95, 0.06);
}

TEST(TableSampler, AnisotropicTablesFollowTheView) {
  const auto material = make_per_view_material(std::make_shared<PerViewBrdf>(test::anisotropic_model()), 0);
  const TableSampler table(*material);
  for (const float phi : {-3.1f, -0.2f, 0.0f, 1.0f, 3.1f}) {
    const Vec3 wv = direction(0.8f, phi);
    EXPECT_GT(test::pdf_one(table, {test::mirror(wv), wv}), 10 * test::pdf_one(table, {wv, wv}));
  }
  EXPECT_GT(table.bytes(), 1'000'000u);
}

}  // namespace
}  // namespace velour::table_sampler_test
