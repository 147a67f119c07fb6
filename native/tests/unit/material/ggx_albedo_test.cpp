#include "material/microfacet/ggx.h"

#include <gtest/gtest.h>

#include "material/microfacet/ggx_sampler.h"

namespace velour::ggx_albedo_test {
namespace {

/// At entries of the tables: cosines n / 31 and n / 15, roughnesses the same.
TEST(GgxAlbedo, IsThatOfTheLobe) {
  for (const float roughness : {8 / 31.0f, 20 / 31.0f, 1.0f}) {
    const SpecularAlbedo finer(Vec2(roughness * roughness), [](float /*cosine*/) { return 1.0f; });
    for (const float cosine : {3 / 31.0f, 12 / 31.0f, 1.0f}) {
      EXPECT_NEAR(ggx_albedo::of_white(roughness, cosine), finer.at(cosine), 2e-3f) << roughness << ' ' << cosine;
    }
  }
  EXPECT_NEAR(ggx_albedo::of_white(0, 0.3f), 1, 1e-3f);
  EXPECT_NEAR(ggx_albedo::mean_of_white(0), 1, 1e-3f);
}

TEST(GgxAlbedo, MeansAreThoseOfTheTable) {
  for (const float roughness : {10 / 31.0f, 1.0f}) {
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
      const double cosine = (i + 0.5) / 1000;
      sum += 2 * cosine * static_cast<double>(ggx_albedo::of_white(roughness, static_cast<float>(cosine))) / 1000;
    }
    EXPECT_NEAR(ggx_albedo::mean_of_white(roughness), sum, 2e-3) << roughness;
  }
}

TEST(GgxAlbedo, SmoothFacetsRiseAsTheSurfaceDoes) {
  for (const float eta : {1.2f, 1.5f, 3.0f}) {
    const float f0 = dielectric_fresnel(1.0f, eta);
    for (const float cosine : {2 / 15.0f, 6 / 15.0f, 1.0f}) {
      const float smooth = (dielectric_fresnel(cosine, eta) - f0) / (1 - f0);
      EXPECT_NEAR(ggx_albedo::mean_rise(0, cosine, eta), smooth, 1e-2f) << eta << ' ' << cosine;
    }
  }
  EXPECT_NEAR(ggx_albedo::mean_rise(0.5f, 1, 1.5f), 0, 2e-3f);
}

/// Facets of rough surfaces that are seen along the surface face the viewer.
TEST(GgxAlbedo, RoughFacetsRiseLess) {
  float before = 1;
  for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
    const float rise = ggx_albedo::mean_rise(roughness, 1 / 15.0f, 1.5f);
    EXPECT_LT(rise, before);
    before = rise;
  }
}

}  // namespace
}  // namespace velour::ggx_albedo_test
