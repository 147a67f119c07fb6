#include "material/principled/principled_material.h"

#include <gtest/gtest.h>

#include "material/microfacet/ggx.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/quadrature.h"
#include "support/materials.h"

namespace velour::principled_material_test {
namespace {

using test::eval_one;

/// int g(w) dw over the upper hemisphere, w in double-length steps fine enough for roughness 0.3 and above.
template <class G>
double integrate_hemisphere(const G& g) {
  const Quadrature z = gauss_legendre(160, 0, 1);
  constexpr int kTurns = 256;
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    const double r = std::sqrt(1 - z.node[i] * z.node[i]);
    for (int k = 0; k < kTurns; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kTurns;
      sum += z.weight[i] * g(Vec3(r * std::cos(phi), r * std::sin(phi), z.node[i]));
    }
  }
  return sum * 2 * kPiD / kTurns;
}

double albedo(const Material& material, const Vec3& wv, int channel) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  return integrate_hemisphere([&](const Vec3& wl) { return eval_one(*point, wl).f[channel] * wl.z; });
}

TEST(Ggx, DistributionProjectsToOne) {
  for (const Vec2& alpha : {Vec2(0.1f), Vec2(0.4f), Vec2(1), Vec2(0.2f, 0.6f)}) {
    EXPECT_NEAR(integrate_hemisphere([&](const Vec3& h) { return ggx_distribution(h, alpha) * h.z; }), 1, 1e-4);
  }
  EXPECT_NEAR(ggx_distribution({0, 0, 1}, Vec2(1e-3f)), 1 / (kPi * 1e-6f), 1);
  EXPECT_EQ(ggx_distribution({0, 0, -1}, Vec2(0.5f)), 0);
}

TEST(Ggx, VisibleNormalsProjectToTheView) {
  for (const Vec2& alpha : {Vec2(0.2f), Vec2(0.7f), Vec2(0.6f, 0.2f)}) {
    for (const Vec3& wv : {direction(0.2f, 0), direction(1.2f, 1)}) {
      const double mass = integrate_hemisphere([&](const Vec3& h) {
        const float cosine = glm::dot(wv, h);
        return cosine > 0 ? 4 * cosine * pdf_ggx_reflection(wv, h, alpha) : 0.0f;
      });
      EXPECT_NEAR(mass, 1, 1e-3);
    }
  }
}

TEST(Fresnel, Limits) {
  EXPECT_NEAR(dielectric_fresnel(1.0f, 1.5f), 0.04f, 1e-6);
  EXPECT_NEAR(dielectric_fresnel(0.0f, 1.5f), 1, 1e-6);
  // Brewster's angle, tan = eta: only the perpendicular polarisation is reflected.
  const float brewster = std::cos(std::atan(1.5f));
  EXPECT_NEAR(dielectric_fresnel(brewster, 1.5f), 0.5f * std::pow((2.25f - 1) / (2.25f + 1), 2.0f), 1e-6);
  EXPECT_EQ(dielectric_fresnel(0.0f, 1), 0);
  EXPECT_EQ(schlick_fresnel(Rgb(0.3f), 1), Rgb(0.3f));
  EXPECT_EQ(schlick_fresnel(Rgb(0.3f), 0), Rgb(1));
}

TEST(Fresnel, OfATintedMetalDipsAt82Degrees) {
  for (const float f0 : {0.1f, 0.5f, 0.9f}) {
    for (const float cosine : {0.0f, 1.0f / 7, 0.4f, 1.0f}) {
      EXPECT_NEAR(tinted_metal_fresnel(f0, 1, cosine), schlick_fresnel(Rgb(f0), cosine).r, 1e-6f);
      EXPECT_GE(tinted_metal_fresnel(f0, 0, cosine), 0);
    }
    EXPECT_NEAR(tinted_metal_fresnel(f0, 0.3f, 1.0f / 7), 0.3f * schlick_fresnel(Rgb(f0), 1.0f / 7).r, 1e-6f);
    EXPECT_EQ(tinted_metal_fresnel(f0, 0, 1.0f), f0);
    EXPECT_EQ(tinted_metal_fresnel(f0, 0, 0.0f), 1);
  }
}

TEST(SpecularAlbedo, OfASmoothSurfaceIsItsFresnelTerm) {
  const SpecularAlbedo table(Vec2(1e-3f), [](float cosine) { return dielectric_fresnel(cosine, 1.5f); });
  for (const float cosine : {0.05f, 0.3f, 0.7f, 1.0f}) {
    EXPECT_NEAR(table.at(cosine), dielectric_fresnel(cosine, 1.5f), 4e-3f) << cosine;
  }
}

TEST(PrincipledMaterial, WithoutSpecularIsLambert) {
  const auto material = make_principled_material({.base_color = {0.2f, 0.5f, 1}, .metallic = 0, .specular = 0});
  for (const Vec3& wv : hemisphere_fibonacci(9)) {
    for (const Vec3& wl : hemisphere_fibonacci(9)) {
      const auto e = eval_one(*material, {.wl = wl, .wv = wv});
      EXPECT_NEAR(e.f.r, 0.2f / kPi, 1e-6);
      EXPECT_NEAR(e.f.b, 1 / kPi, 1e-6);
      EXPECT_NEAR(e.pdf, wl.z / kPi, 1e-6);
    }
  }
}

TEST(PrincipledMaterial, WhiteReflectsAllLight) {
  for (const float roughness : {0.4f, 0.7f, 1.0f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      const auto material =
          make_principled_material({.base_color = Rgb(1), .metallic = metallic, .roughness = roughness});
      for (const float theta_v : {0.0f, 0.8f, 1.3f}) {
        EXPECT_NEAR(albedo(*material, direction(theta_v, 0), 1), 1, 5e-3) << roughness << ' ' << theta_v;
      }
    }
  }
}

TEST(PrincipledMaterial, WithoutInterreflectionRoughMetalIsDarker) {
  const auto of = [](GgxLobe lobe) {
    return albedo(*make_principled_material({.base_color = Rgb(1), .metallic = 1, .roughness = 1, .lobe = lobe}),
                  direction(0.8f, 0), 1);
  };
  EXPECT_NEAR(of(GgxLobe::single), ggx_albedo::of_white(1, std::cos(0.8f)), 3e-3);
  EXPECT_LT(of(GgxLobe::separable), 0.97 * of(GgxLobe::single));
}

TEST(PrincipledMaterial, ACoatedMetalIsSharpAndBroad) {
  const PrincipledParameters bare{.base_color = Rgb(0.5f), .metallic = 1, .roughness = 0.6f};
  PrincipledParameters coated = bare;
  coated.coat = 1;
  coated.coat_roughness = 0.1f;
  const DirectionPair mirror{.wl = direction(0.3f, kPi), .wv = direction(0.3f, 0)};
  const DirectionPair beside{.wl = direction(0.8f, kPi), .wv = direction(0.3f, 0)};
  const auto f = [](const PrincipledParameters& p, const DirectionPair& w) {
    return eval_one(*make_principled_material(p), w).f.r;
  };
  EXPECT_GT(f(coated, mirror), 10 * f(bare, mirror));
  EXPECT_NEAR(f(coated, beside) / f(bare, beside), 0.96f, 1e-3f);  // what the coat lets through to the viewer
}

TEST(PrincipledMaterial, NeverReflectsMoreThanItReceives) {
  for (const float roughness : {0.4f, 1.0f}) {
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
      for (const float specular : {0.0f, 0.5f, 1.0f}) {
        for (const float coat : {0.0f, 1.0f}) {
          const auto material = make_principled_material({.base_color = Rgb(1),
                                                          .metallic = metallic,
                                                          .roughness = roughness,
                                                          .specular = specular,
                                                          .coat = coat,
                                                          .coat_roughness = 0.4f});
          for (const float theta_v : {0.1f, 1.0f, 1.4f}) {
            EXPECT_LT(albedo(*material, direction(theta_v, 0), 0), 1.003) << roughness << metallic << specular << coat;
          }
        }
      }
    }
  }
}

TEST(PrincipledMaterial, IsTheSumOfItsParts) {
  PrincipledParameters p{.base_color = {0.9f, 0.4f, 0.1f}, .metallic = 0.3f, .coat = 0.6f, .coat_roughness = 0.3f};
  for (const PrincipledFormula formula : {PrincipledFormula::layered, PrincipledFormula::disney}) {
    p.formula = formula;
    for (const Vec3& wl : hemisphere_fibonacci(9)) {
      const auto value = [&](PrincipledPart part) {
        p.part = part;
        return eval_one(*make_principled_material(p), {.wl = wl, .wv = direction(0.9f, 0)}).f;
      };
      const Rgb whole = value(PrincipledPart::whole), base = value(PrincipledPart::base);
      const Rgb lobes = value(PrincipledPart::specular) + value(PrincipledPart::coat);
      EXPECT_LT(glm::distance(whole, base + lobes), 1e-6f * (1 + whole.r));
      EXPECT_GT(base.r, 0.1f);
    }
  }
}

TEST(PrincipledMaterial, IsFiniteInEveryCorner) {
  for (const float roughness : {0.0f, 0.01f, 1.0f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      for (const Rgb& color : {Rgb(0), Rgb(1), Rgb(-1, 2, 0.5f)}) {
        const auto material = make_principled_material({color, metallic, roughness, 0.5f, color, metallic, roughness});
        for (const Vec3& wv : {Vec3(0, 0, 1), direction(1.5707f, 0.4f), Vec3(0, 1, 1e-7f)}) {
          ScratchArena arena;
          const PreparedBrdf* const point = material->prepare(wv, arena);
          for (const Vec3& wl : {wv, -wv, test::mirror(wv), Vec3(1, 0, 0), Vec3(0, 0, -1), direction(1.57f, 3.5f)}) {
            const auto e = eval_one(*point, wl);
            EXPECT_TRUE(std::isfinite(e.f.r + e.f.g + e.f.b) && std::isfinite(e.pdf));
            EXPECT_GE(std::min({e.f.r, e.f.g, e.f.b, e.pdf}), 0);
            if (wl.z <= 0) {
              EXPECT_EQ(e.f, Rgb(0));
            }
          }
          for (const Vec2& u : {Vec2(0, 0), Vec2(1 - 0x1p-24f), Vec2(0.5f)}) {
            EXPECT_NEAR(glm::length(point->sample_one(u)), 1, 1e-5f);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace velour::principled_material_test
