// The products of a material's lobes with a sky: samples against the density, and the whole strategy where the answer
// is known.
#include <gtest/gtest.h>

#include "material/scattered_material.h"
#include "render/sky_proposals.h"
#include "sphere/random.h"
#include "support/chi_square.h"
#include "support/statistics.h"
#include "support/test_scene.h"

namespace velour {
namespace {

using test::ChiSquareOptions;
using test::ChiSquareResult;

SkyMixture sky_of(int lobes, float sharpest) {
  SkyMixture sky;
  RandomStream random(5, 0, 0);
  for (int k = 0; k < lobes; ++k) {
    sky.center.push_back(sample_uniform_sphere(random.next2()));
    sky.bandwidth.push_back(2 * std::pow(sharpest / 2, random.next()));
    sky.coefficient.push_back(Rgb(random.next() * sky.bandwidth.back()));
  }
  return sky;
}

ProposalLobes glossy() {
  ProposalLobes brdf;
  brdf.cosine = 0.1f;
  brdf.lobe[brdf.count++] = {glm::normalize(Vec3(0.6f, 0, 0.7f)), 60, 3.0f};
  brdf.lobe[brdf.count++] = {glm::normalize(Vec3(0.3f, 0.2f, 0.9f)), 6, 0.4f};
  return brdf;
}

double density(const LobeMixture& mixture, const Vec3& w) {
  DirectionBatch batch;
  batch.push(w);
  batch.pad();
  ScalarBatch pdf;
  eval_density(mixture, batch, pdf);
  return static_cast<double>(pdf.v[0]);
}

const Frame kFrame = Frame::about(glm::normalize(Vec3(0.2f, -0.7f, 0.5f)));

LobeMixture proposal(const SkyMixture& sky) {
  LobeMixture mixture;
  LobeProducts scratch;
  EXPECT_TRUE(SkyProposals(sky).propose(glossy(), kFrame, scratch, mixture));
  return mixture;
}

ChiSquareResult judge(const LobeMixture& sampled, const LobeMixture& claimed) {
  ChiSquareOptions options;
  options.samples = 400'000;
  // Cells about the sharpest product that matters.
  int sharpest = 0;
  for (int k = 1; k < sampled.count; ++k) {
    if (sampled.bandwidth[k] > sampled.bandwidth[sharpest]) sharpest = k;
  }
  options.axis = {sampled.x[sharpest], sampled.y[sharpest], sampled.z[sharpest]};
  options.concentration = sampled.bandwidth[sharpest];
  return test::chi_square([&](const Vec2& u) { return sample_mixture(sampled, u); },
                          [&](const Vec3& w) { return density(claimed, w); }, options);
}

TEST(ProductSampling, FollowsItsDensityWhichIntegratesToOne) {
  const double level = test::sidak_level(0.01, 3);
  for (const int lobes : {1, 20, 200}) {
    const LobeMixture mixture = proposal(sky_of(lobes, 500));
    const ChiSquareResult result = judge(mixture, mixture);
    EXPECT_EQ(result.problem, "") << lobes;
    EXPECT_GT(result.p_value, level) << lobes;
    EXPECT_NEAR(result.density_mass, 1, 1e-3) << lobes;
  }
}

TEST(ProductSampling, RejectsABandwidthOffByFivePercent) {
  const LobeMixture sampled = proposal(sky_of(20, 500));
  LobeMixture wrong = sampled;
  for (int k = 0; k < wrong.count; ++k) {
    wrong.bandwidth[k] *= 1.05f;
    wrong.density[k] *= 1.05f;  // stays a density: all these lobes are narrow enough
  }
  EXPECT_LT(judge(sampled, wrong).p_value, 1e-6);
}

TEST(ProductSampling, GoesWhereBothAre) {
  // Density at the product of a highlight and a sun inside it, against either alone.
  SkyMixture sky;
  sky.center = {kFrame.to_world(glm::normalize(Vec3(0.6f, 0.05f, 0.7f))), kFrame.to_world({-0.8f, 0, 0.6f})};
  sky.bandwidth = {3000, 3000};
  sky.coefficient = {Rgb(1.0f), Rgb(1.0f)};
  const LobeMixture mixture = proposal(sky);
  EXPECT_GT(density(mixture, sky.center[0]), 20 * density(mixture, sky.center[1]));
}

TEST(ProductSampling, NothingToProposeBelowTheHorizon) {
  SkyMixture sky;
  sky.center = {-kFrame.z};
  sky.bandwidth = {1e5f};
  sky.coefficient = {Rgb(1.0f)};
  LobeMixture mixture;
  LobeProducts scratch;
  EXPECT_FALSE(SkyProposals(sky).propose(glossy(), kFrame, scratch, mixture));
  EXPECT_FALSE(SkyProposals({}).propose(glossy(), kFrame, scratch, mixture));
}

std::shared_ptr<const Material> lobe_material() {
  auto brdf = std::make_shared<ScatteredBrdf>();
  for (const float theta : {0.0f, 0.5f, 1.0f, 1.5f}) {
    brdf->first_lobe.push_back(static_cast<uint32_t>(brdf->center.size()));
    brdf->views.push_back(direction(theta, 0.0f));
    brdf->center.push_back(direction(-theta, 0.0f));
    brdf->bandwidth.push_back(50);
    brdf->coefficient.emplace_back(2.0f, 1.5f, 1.0f);
    brdf->diffuse.emplace_back(0.1f);
  }
  brdf->first_lobe.push_back(static_cast<uint32_t>(brdf->center.size()));
  brdf->isotropic = true;
  brdf->default_neighbors = 2;
  return make_scattered_material(brdf, 2);
}

/// Two spheres that shade each other, of a material that has lobes, under an uneven sky and a lamp.
Scene pair(Environment environment, bool lamp) {
  Scene scene;
  scene.add_mesh(test::sphere(24));
  scene.add_material({lobe_material(), Rgb(0.0f), true});
  scene.add_instance(0, {}, {0});
  scene.add_instance(0, test::shift({1.2f, 0.4f, 0.9f}, Vec3(0.5f)), {0});
  scene.set_environment(std::move(environment));
  if (lamp) {
    Light light;
    light.type = Light::Type::rectangle;
    light.light_to_world = test::shift({1, 1, 4});
    light.size = {1, 1};
    light.color = Rgb(40.0f);
    scene.add_light(light);
  }
  scene.set_camera(test::camera_above(0.7f));
  scene.commit(2);
  return scene;
}

Environment uneven(float strength) {
  std::vector<float> pixels(3 * 32 * 16);
  RandomStream random(3, 3, 3);
  for (float& p : pixels) p = std::pow(random.next(), 6.0f);
  return Environment::image({32, 16, 3, pixels}, strength, Mat3(1.0f));
}

test::RunningMean brightness(const Scene& scene, Strategy strategy, int spp, int split = 8) {
  test::RunningMean mean;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    RenderOptions options = test::small_options(strategy, spp);
    options.seed = seed * 7 + static_cast<uint64_t>(strategy);
    options.split = split;
    options.bounces = 0;
    mean.add(test::mean_of(test::rendered(scene, options)));
  }
  return mean;
}

double p_of(const test::RunningMean& a, const test::RunningMean& b) {
  return test::z_test(a.mean(), a.standard_error(), b.mean(), b.standard_error());
}

TEST(ProductStrategy, AgreesWithMis) {
  for (const bool lamp : {false, true}) {
    const Scene scene = pair(uneven(1), lamp);
    const test::RunningMean mis = brightness(scene, Strategy::mis, 64);
    for (const int split : {1, 3, 8}) {
      const test::RunningMean product = brightness(scene, Strategy::product, 64, split);
      EXPECT_GT(p_of(product, mis), test::sidak_level(0.01, 6)) << lamp << ' ' << split;
    }
  }
}

TEST(ProductStrategy, NegativeControlASkyFivePercentBrighterIsSeen) {
  const test::RunningMean brighter = brightness(pair(uneven(1.05f), false), Strategy::product, 64);
  EXPECT_LT(p_of(brighter, brightness(pair(uneven(1), false), Strategy::mis, 64)), 1e-4);
}

TEST(ProductStrategy, UnderAConstantSkyToo) {
  const Scene scene = pair(Environment::constant(Rgb(1.0f)), false);
  EXPECT_GT(p_of(brightness(scene, Strategy::product, 64), brightness(scene, Strategy::cosine, 64)), 0.005);
}

}  // namespace
}  // namespace velour
