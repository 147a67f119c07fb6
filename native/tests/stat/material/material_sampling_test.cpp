// Every material's sampler against the density that it claims: all angles of the view, all widths of the highlight.
#include "brdf/eval/per_view_lobes.h"
#include "brdf/eval/per_view_material.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/principled/principled_material.h"
#include "support/lobe_cells.h"
#include "support/proof_materials.h"
#include "support/statistics.h"

namespace velour::material_sampling_test {
namespace {

using test::Sampler;

/// Cells about the mirror direction, where the highlight of half-vector lobes is; `alpha` is their roughness. Away from
/// the normal a highlight is narrower across the plane of incidence than along it, by the cosine.
Sampler about_mirror(std::shared_ptr<const Material> material, const Vec3& wv, float alpha) {
  Sampler sampler = test::material_sampler(std::move(material), wv);
  const double across = 2 * static_cast<double>(alpha) * static_cast<double>(std::max(wv.z, 0.01f));
  if (alpha >= 0.3f) return sampler;  // edges of cells about the normal do not cross the horizon
  sampler.axis = test::mirror(wv);
  sampler.concentration = 1 / (across * across);
  return sampler;
}

struct LobeMaterialCase {
  test::LobeMaterial lobes;
  float bandwidth, degrees;
};

void PrintTo(const LobeMaterialCase& c, std::ostream* out) {
  *out << c.lobes.name << ", bandwidth " << c.bandwidth << ", view " << c.degrees << " degrees";
}

std::vector<LobeMaterialCase> lobe_material_cases() {
  std::vector<LobeMaterialCase> cases;
  for (const auto& lobes : test::kLobeMaterials) {
    for (const float bandwidth : lobes.bandwidths) {
      for (const float degrees : test::kViewAngles) cases.push_back({lobes, bandwidth, degrees});
    }
  }
  return cases;
}

class LobeMaterialSampling : public ::testing::TestWithParam<LobeMaterialCase> {};

/// Cells about the sharpest of the lobes that the material has at the view.
Sampler lobe_material_sampler(const test::LobeMaterial& kind, float bandwidth, float degrees, bool interpolated) {
  const auto material = kind.make(bandwidth);
  const Vec3 wv = test::view_at(degrees);
  const auto draws = std::make_unique<LobeMixture>();
  const PerViewLobes lobes(kind.model(bandwidth), 0);
  lobes.gather(lobes.place_nearest(wv), *draws);
  Sampler sampler = test::material_sampler(material, wv, SurfaceSite::everywhere(), interpolated);
  test::resolve_lobe(*draws, test::sharpest_lobe(*draws), sampler);
  if (!interpolated) sampler.refinements = {1, 3};  // below the horizon a table ends within a cell
  return sampler;
}

TEST_P(LobeMaterialSampling, FollowsItsDensity) {
  const auto& [lobes, bandwidth, degrees] = GetParam();
  test::expect_proven(lobe_material_sampler(lobes, bandwidth, degrees, false), "material");
}

TEST(InterpolatedViewsSampling, FollowsItsDensity) {
  for (const auto& lobes : test::kLobeMaterials) {
    for (const float bandwidth : {lobes.bandwidths.front(), lobes.bandwidths.back()}) {
      for (const float degrees : {0.0f, 47.0f, 85.0f}) {
        test::expect_proven(lobe_material_sampler(lobes, bandwidth, degrees, true), "interpolated");
      }
    }
  }
}

/// Relative variance of f cos / pdf over directions that are drawn at views of even irradiance.
double spread(const Material& material, bool interpolated) {
  constexpr int kViews = 40, kSamples = 1000;
  double sum = 0;
  ScratchArena arena;
  for (int v = 0; v < kViews; ++v) {
    const float sine = std::sqrt((static_cast<float>(v) + 0.5f) / kViews);
    arena.reset();
    const PreparedBrdf* const point =
        material.prepare(direction(std::asin(sine), 0.4f), {}, {.interpolated_draws = interpolated}, arena);
    test::RunningMean mean;
    for (uint64_t i = 0; i < kSamples; ++i) {
      const Vec3 wl = point->sample_one(RandomStream(5, static_cast<uint64_t>(v), i).next2());
      const auto e = test::eval_one(*point, wl);
      mean.add(wl.z > 0 ? static_cast<double>(luminance(e.f) * wl.z / e.pdf) : 0.0);
    }
    sum += mean.variance() / (mean.mean() * mean.mean());
  }
  return sum / kViews;
}

// The point of tables beside the dissertation's density: as good a fit, drawn from by one map.
TEST(PerViewDraws, VaryAsLittleAsTheInterpolatedDensity) {
  for (const auto& lobes : {test::kLobeMaterials[0], test::kLobeMaterials[1]}) {
    for (const float bandwidth : lobes.bandwidths) {
      if (bandwidth > 1e4f || bandwidth == 0.999f) continue;  // a row of the tables is half a deviation, or more
      const auto material = lobes.make(bandwidth);
      EXPECT_LT(spread(*material, false), 1.3 * spread(*material, true)) << lobes.name << ' ' << bandwidth;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, LobeMaterialSampling, ::testing::ValuesIn(lobe_material_cases()));

struct GgxCase {
  const char* name;
  GgxParameters parameters;
  float degrees;
};

void PrintTo(const GgxCase& c, std::ostream* out) { *out << c.name << ", view " << c.degrees << " degrees"; }

GgxParameters ggx(const Vec2& alpha, float diffuse) {
  return {.alpha = alpha, .f0 = Rgb(0.5f), .f90 = Rgb(1), .diffuse = Rgb(diffuse)};
}

std::vector<GgxCase> ggx_cases() {
  const std::pair<const char*, GgxParameters> lobes[] = {{"roughness 0.001", ggx(Vec2(1e-3f), 0)},
                                                         {"roughness 0.01", ggx(Vec2(1e-2f), 0.2f)},
                                                         {"roughness 0.1", ggx(Vec2(0.1f), 0)},
                                                         {"roughness 0.5 with a base", ggx(Vec2(0.5f), 0.3f)},
                                                         {"roughness 1", ggx(Vec2(1), 0)},
                                                         {"roughness 0.15 and 0.5", ggx({0.15f, 0.5f}, 0.1f)},
                                                         {"roughness 0.003 and 0.001", ggx({3e-3f, 1e-3f}, 0)},
                                                         {"roughness 0.9 and 0.3", ggx({0.9f, 0.3f}, 0)}};
  std::vector<GgxCase> cases;
  for (const auto& [name, parameters] : lobes) {
    for (const float degrees : test::kViewAngles) cases.push_back({name, parameters, degrees});
  }
  return cases;
}

Sampler ggx_sampler(const GgxParameters& parameters, float degrees) {
  return about_mirror(make_ggx_material(parameters), test::view_at(degrees),
                      std::min(parameters.alpha.x, parameters.alpha.y));
}

class GgxSampling : public ::testing::TestWithParam<GgxCase> {};

TEST_P(GgxSampling, FollowsItsDensity) {
  test::expect_proven(ggx_sampler(GetParam().parameters, GetParam().degrees), "ggx");
}

INSTANTIATE_TEST_SUITE_P(All, GgxSampling, ::testing::ValuesIn(ggx_cases()));

struct PrincipledCase {
  const char* name;
  PrincipledParameters parameters;
  float degrees;
};

void PrintTo(const PrincipledCase& c, std::ostream* out) { *out << c.name << ", view " << c.degrees << " degrees"; }

std::vector<PrincipledCase> principled_cases() {
  const std::pair<const char*, PrincipledParameters> kinds[] = {
      {"lambert", {.base_color = Rgb(0.5f), .specular = 0}},
      {"plastic", {.base_color = {0.2f, 0.5f, 0.8f}, .roughness = 0.4f}},
      {"rough metal", {.metallic = 1, .roughness = 1}},
      {"metal", {.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 1, .roughness = 0.35f}},
      {"mirror", {.metallic = 1, .roughness = 0.03f}},
      {"coated metal", {.metallic = 1, .roughness = 0.95f, .coat = 0.8f, .coat_roughness = 0.56f}},
      {"before Blender 4",
       {.metallic = 0.3f, .roughness = 0.6f, .formula = PrincipledFormula::disney, .lobe = GgxLobe::separable}}};
  std::vector<PrincipledCase> cases;
  for (const auto& [name, parameters] : kinds) {
    for (const float degrees : test::kViewAngles) cases.push_back({name, parameters, degrees});
  }
  return cases;
}

class PrincipledSampling : public ::testing::TestWithParam<PrincipledCase> {};

TEST_P(PrincipledSampling, FollowsItsDensity) {
  const auto& [name, parameters, degrees] = GetParam();
  const float sharpest =
      parameters.coat > 0 ? std::min(parameters.roughness, parameters.coat_roughness) : parameters.roughness;
  const float alpha = std::max(sharpest * sharpest, 1e-3f);
  test::expect_proven(about_mirror(make_principled_material(parameters), test::view_at(degrees), alpha), name);
}

INSTANTIATE_TEST_SUITE_P(All, PrincipledSampling, ::testing::ValuesIn(principled_cases()));

TEST(MaterialSamplingControl, AnotherMaterialsDensityIsSeen) {
  const auto lobes = [](float bandwidth) {
    return lobe_material_sampler(test::kLobeMaterials[0], bandwidth, 42.5f, false);
  };
  EXPECT_LT(test::p_value(lobes(1e6f), lobes(1.05e6f)), 1e-6);
  EXPECT_LT(test::p_value(lobes(100), lobes(105)), 1e-6);
  const auto lobe = [](const Vec2& alpha, float diffuse) { return ggx_sampler(ggx(alpha, diffuse), 45); };
  EXPECT_GT(test::p_value(lobe({0.1f, 0.2f}, 0.1f), lobe({0.1f, 0.2f}, 0.1f)), 1e-4);
  EXPECT_LT(test::p_value(lobe({0.1f, 0.2f}, 0.1f), lobe({0.105f, 0.2f}, 0.1f)), 1e-6);
  EXPECT_LT(test::p_value(lobe({0.1f, 0.2f}, 0.1f), lobe({0.1f, 0.21f}, 0.1f)), 1e-6);
  EXPECT_LT(test::p_value(lobe({0.1f, 0.2f}, 0.1f), lobe({0.1f, 0.2f}, 0.12f)), 1e-6);
}

}  // namespace
}  // namespace velour::material_sampling_test
