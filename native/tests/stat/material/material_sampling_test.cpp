#include "judge.h"
#include "material/principled_material.h"
#include "material/scattered_material.h"
#include "sphere/quadrature.h"
#include "sphere/random.h"
#include "support/statistics.h"

namespace velour {
namespace {

using test::eval_one;
using test::judge;
using test::quick_options;

std::shared_ptr<const Material> scattered(const ScatteredBrdf& brdf) {
  return make_scattered_material(std::make_shared<ScatteredBrdf>(brdf), 0);
}

/// A measurement with a closed form: a Lambertian base and a broad lobe about the mirror direction, not reciprocal.
class SyntheticMeasurement final : public Measurement {
 public:
  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    for (size_t i = 0; i < wl.size(); ++i) {
      valid[i] = wl[i].z > 0;
      const float lobe = std::pow(std::max(glm::dot(wl[i], test::mirror(wv)), 0.0f), 20.0f);
      f[i] = valid[i] ? Rgb(0.1f, 0.2f, 0.3f) + wv.z * lobe : Rgb(0);
    }
  }
  bool isotropic() const override { return true; }
  bool covers_view(float) const override { return true; }
};

std::shared_ptr<const Material> measured(const ScatteredBrdf& proposal) {
  return make_measured_material(std::make_shared<SyntheticMeasurement>(), std::make_shared<ScatteredBrdf>(proposal), 0);
}

struct Named {
  std::string name;
  std::shared_ptr<const Material> material;
};

std::vector<Named> judged_materials() {
  return {{"isotropic gaussian", scattered(test::isotropic_model())},
          {"isotropic abel-poisson", scattered(test::isotropic_model(Kernel::abel_poisson))},
          {"hemisphere gaussian", scattered(test::anisotropic_model())},
          {"measured", measured(test::isotropic_model())},
          {"lambert", make_principled_material({.base_color = Rgb(0.5f), .specular = 0})},
          {"plastic", make_principled_material({.base_color = {0.2f, 0.5f, 0.8f}, .roughness = 0.4f})},
          {"rough metal", make_principled_material({.metallic = 1, .roughness = 1})},
          {"metal", make_principled_material({.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 1, .roughness = 0.35f})}};
}

TEST(MaterialSampling, FollowsItsDensity) {
  const auto materials = judged_materials();
  const auto views = test::judged_views();
  const double level = test::sidak_level(0.01, static_cast<int>(materials.size() * views.size()));
  uint64_t seed = 100;
  for (const Named& m : materials) {
    for (const Vec3& wv : views) {
      expect_accepted(judge(*m.material, *m.material, wv, quick_options(++seed)), level,
                      m.name + " at cosine " + std::to_string(wv.z));
    }
  }
}

// Cells about the mirror direction, logarithmic in its distance, resolve a lobe of a twentieth of a degree.
TEST(MaterialSampling, FollowsItsDensityNearAMirror) {
  const auto mirror_like = make_principled_material({.metallic = 1, .roughness = 0.04f});
  const auto sharp = scattered(test::glossy_model(Kernel::gaussian, test::meridian_views(), true, 1e5f));
  for (const auto& material : {mirror_like, sharp}) {
    for (const float degrees : {0.0f, 45.0f, 70.0f}) {
      const Vec3 wv = direction(radians_from(degrees), 1.3f);
      test::ChiSquareOptions options = quick_options(7);
      options.axis = test::mirror(wv);
      options.concentration = 1e5;
      test::expect_accepted(judge(*material, *material, wv, options), test::sidak_level(0.01, 6),
                            std::to_string(degrees));
    }
  }
}

TEST(MaterialSampling, RejectsADensityThatIsNotItsOwn) {
  const Vec3 wv = direction(radians_from(42.5f), 0.4f);  // between two sampled views
  test::ChiSquareOptions options = quick_options(1);
  options.axis = test::mirror(wv);
  options.concentration = 300;
  options.phi_cells = 8;
  options.samples = 1'000'000;
  const auto rejected = [&](const Material& sampled, const Material& claimed) {
    return judge(sampled, claimed, wv, options).p_value < 1e-6;
  };
  const auto metal = make_principled_material({.metallic = 1, .roughness = 0.5f});
  EXPECT_TRUE(rejected(*metal, *make_principled_material({.metallic = 1, .roughness = 0.51f})));
  const auto views = test::meridian_views();
  const auto glossy = scattered(test::glossy_model(Kernel::gaussian, views, true, 300));
  EXPECT_FALSE(rejected(*glossy, *glossy));
  EXPECT_TRUE(rejected(*glossy, *scattered(test::glossy_model(Kernel::gaussian, views, true, 315))));
  ScatteredBrdf not_aligned = test::isotropic_model();
  not_aligned.align_views = false;
  EXPECT_TRUE(rejected(*glossy, *scattered(not_aligned)));
}

double albedo_by_quadrature(const Material& material, const Vec3& wv) {
  const Quadrature z = gauss_legendre(200, 0, 1);
  constexpr int kTurns = 400;
  PreparedBrdf point;
  material.prepare(wv, point);
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    const double r = std::sqrt(1 - z.node[i] * z.node[i]);
    for (int k = 0; k < kTurns; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kTurns;
      const Vec3 wl(r * std::cos(phi), r * std::sin(phi), z.node[i]);
      sum += z.weight[i] * z.node[i] * eval_one(material, point, wl).f.g;
    }
  }
  return sum * 2 * kPiD / kTurns;
}

/// Mean of f cos / pdf over samples: the estimator of a constant environment. `error` scales the density, for control.
test::RunningMean albedo_by_sampling(const Material& material, const Vec3& wv, double error = 1) {
  PreparedBrdf point;
  material.prepare(wv, point);
  test::RunningMean mean;
  for (uint64_t i = 0; i < 100'000; ++i) {
    const Vec3 wl = material.sample(point, RandomStream(5, 0, i).next2());
    const auto e = eval_one(material, point, wl);
    mean.add(wl.z > 0 ? e.f.g * wl.z / (e.pdf * error) : 0.0);
  }
  return mean;
}

TEST(MaterialSampling, EstimatesTheAlbedoWithoutBias) {
  const auto materials = judged_materials();
  const double level = test::sidak_level(0.01, static_cast<int>(materials.size() * 3));
  for (const Named& m : materials) {
    for (const float degrees : {0.0f, 45.0f, 75.0f}) {
      const Vec3 wv = direction(radians_from(degrees), 0.7f);
      const double expected = albedo_by_quadrature(*m.material, wv);
      const test::RunningMean mean = albedo_by_sampling(*m.material, wv);
      EXPECT_GT(test::z_test(mean.mean(), mean.standard_error(), expected, 1e-5 * expected), level)
          << m.name << ' ' << degrees << ": " << mean.mean() << " +- " << mean.standard_error() << ", " << expected;
    }
  }
}

// A proposal that knows nothing of the material costs variance, never truth.
TEST(MaterialSampling, ABadProposalIsUnbiased) {
  ScatteredBrdf bad = test::glossy_model(Kernel::gaussian, {{0, 0, 1}}, true, 2000);
  bad.center[0] = direction(1.2f, 1);
  const auto material = measured(bad);
  const Vec3 wv = direction(0.7f, 2);
  const double expected = albedo_by_quadrature(*material, wv);
  const test::RunningMean mean = albedo_by_sampling(*material, wv);
  EXPECT_GT(test::z_test(mean.mean(), mean.standard_error(), expected, 0), 0.005);
  const test::RunningMean wrong = albedo_by_sampling(*material, wv, 1.1);
  EXPECT_LT(test::z_test(wrong.mean(), wrong.standard_error(), expected, 0), 1e-4);
}

}  // namespace
}  // namespace velour
