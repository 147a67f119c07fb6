// Samples over their density against quadrature of the value: the estimator that every render is made of.
#include "support/albedo.h"
#include "brdf/eval/parametric_material.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/principled/principled_material.h"
#include "math/sphere/random.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/statistics.h"

namespace velour::albedo_test {
namespace {

using test::eval_one;

struct Named {
  std::string name;
  std::shared_ptr<const Material> material;
};

std::vector<Named> materials() {
  std::vector<Named> all{
      {"lambert", make_principled_material({.base_color = Rgb(0.5f), .specular = 0})},
      {"plastic", make_principled_material({.base_color = {0.2f, 0.5f, 0.8f}, .roughness = 0.4f})},
      {"rough metal", make_principled_material({.metallic = 1, .roughness = 1})},
      {"metal", make_principled_material({.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 1, .roughness = 0.35f})},
      {"ggx", make_ggx_material({.alpha = {0.2f, 0.5f}, .f0 = Rgb(0.5f), .f90 = Rgb(1), .diffuse = Rgb(0.1f)})}};
  for (const bool isotropic : {true, false}) {
    all.push_back({isotropic ? "parametric" : "parametric, anisotropic",
                   make_parametric_material(test::parametric_highlight(200, isotropic))});
  }
  for (const auto& kind : test::kLobeMaterials) {
    const float broad = std::string(kind.name) == "isotropic abel-poisson" ? 0.9f : 100;
    all.push_back({kind.name, kind.make(broad)});
  }
  return all;
}

/// Mean of f cos / pdf over samples: the estimator of a constant environment. `error` scales the density, for control.
test::Estimate albedo_by_sampling(const Material& material, const Vec3& wv, double error = 1) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  test::RunningMean mean;
  for (uint64_t i = 0; i < 100'000; ++i) {
    const Vec3 wl = point->sample_one(RandomStream(5, 0, i).next2());
    const auto e = eval_one(*point, wl);
    mean.add(wl.z > 0 ? e.f.g * wl.z / (e.pdf * error) : 0.0);
  }
  return mean.estimate();
}

test::Estimate by_quadrature(const Material& material, const Vec3& wv) {
  const double value = test::albedo(material, wv, 200, 400);
  return {value, 1e-5 * value};
}

test::ZTests albedos(double error) {
  test::ZTests tests;
  for (const Named& m : materials()) {
    for (const float degrees : {0.0f, 45.0f, 75.0f}) {
      const Vec3 wv = test::view_at(degrees);
      tests.add(m.name + ' ' + std::to_string(degrees), albedo_by_sampling(*m.material, wv, error),
                by_quadrature(*m.material, wv));
    }
  }
  return tests;
}

TEST(Albedo, IsEstimatedWithoutBias) {
  const test::ZTests tests = albedos(1);
  EXPECT_TRUE(tests.agree());
  for (const Named& m : materials())
    EXPECT_LT(tests.smallest_bias(m.name + ' ' + std::to_string(45.0f)), 0.04) << m.name;
}

TEST(Albedo, ControlADensityFivePercentTooHighIsSeen) { EXPECT_TRUE(albedos(1.05).differ()); }

// A proposal that knows nothing of the material costs variance, never truth.
TEST(Albedo, ABadProposalIsUnbiased) {
  PerViewBrdf bad = test::glossy_model(Kernel::gaussian, {{0, 0, 1}}, true, 2000);
  bad.center[0] = direction(1.2f, 1);
  const auto material = test::measured(bad);
  test::ZTests tests, control;
  tests.add("bad proposal", albedo_by_sampling(*material, test::view_at(40)),
            by_quadrature(*material, test::view_at(40)));
  control.add("", albedo_by_sampling(*material, test::view_at(40), 1.05), by_quadrature(*material, test::view_at(40)));
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

}  // namespace
}  // namespace velour::albedo_test
