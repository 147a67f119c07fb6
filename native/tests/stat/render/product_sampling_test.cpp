// The products of a material's lobes with a sky: samples against the density, and the whole strategy where the answer
// is known.
#include "light/environment_mixture.h"
#include "render/lights/environment_proposals.h"
#include "support/level.h"
#include "support/lobe_cells.h"
#include "support/proof_materials.h"
#include "support/renders.h"
#include "support/test_data.h"

namespace velour::product_sampling_test {
namespace {

EnvironmentMixture sky_of(int lobes, float sharpest) {
  EnvironmentMixture sky;
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

const Frame kFrame = Frame::about(glm::normalize(Vec3(0.2f, -0.7f, 0.5f)));

LobeMixture proposal(const EnvironmentMixture& sky, const ProposalLobes& brdf = glossy(), const Frame& frame = kFrame) {
  LobeMixture mixture;
  LobeProducts scratch;
  EXPECT_TRUE(EnvironmentProposals(sky).propose(brdf, frame, scratch, mixture));
  return mixture;
}

/// A sky of `lobes`, the sharpest of which has bandwidth `sharpest`, and a material with a highlight of `bandwidth`
/// seen at `degrees`.
struct ProposalCase {
  int lobes;
  float sharpest, bandwidth, degrees;
};

void PrintTo(const ProposalCase& c, std::ostream* out) {
  *out << c.lobes << " sky lobes up to " << c.sharpest << ", highlight " << c.bandwidth << ", view " << c.degrees
       << " degrees";
}

std::vector<ProposalCase> proposal_cases() {
  std::vector<ProposalCase> cases;
  for (const float degrees : test::kViewAngles) {
    for (const float bandwidth : {1e-4f, 1.0f, 100.0f, 1e4f, 1e6f}) {
      cases.push_back({degrees < 40 ? 200 : 20, bandwidth > 1000 ? 10.0f : 500.0f, bandwidth, degrees});
    }
  }
  cases.push_back({1, 1e6f, 1, 45});
  cases.push_back({1, 1e6f, 1e6f, 45});
  return cases;
}

class ProposalSampling : public ::testing::TestWithParam<ProposalCase> {};

TEST_P(ProposalSampling, FollowsItsDensity) {
  const auto [lobes, sharpest, bandwidth, degrees] = GetParam();
  const auto material = test::highlight_material(bandwidth);
  ScratchArena arena;
  const PreparedBrdf* const point = material->prepare(test::view_at(degrees), arena);
  EnvironmentMixture sky = sky_of(lobes, sharpest);
  if (lobes == 1) sky.bandwidth = {sharpest}, sky.center = {kFrame.to_world(test::mirror(test::view_at(degrees)))};
  ProposalLobes few;
  ASSERT_TRUE(point->proposal_lobes(few));
  test::expect_proven(test::mixture_sampler(proposal(sky, few)), "proposal");
}

INSTANTIATE_TEST_SUITE_P(All, ProposalSampling, ::testing::ValuesIn(proposal_cases()));

TEST(ProposalSamplingControl, ABandwidthOffByFivePercentIsSeen) {
  const LobeMixture sampled = proposal(sky_of(20, 500));
  LobeMixture wrong = sampled;
  for (int k = 0; k < wrong.count; ++k) {
    wrong.bandwidth[k] *= 1.05f;
    wrong.density[k] *= 1.05f;  // stays a density: all these lobes are narrow enough
  }
  EXPECT_LT(test::p_value(test::mixture_sampler(sampled), test::mixture_sampler(wrong)), 1e-6);
}

TEST(ProductSampling, GoesWhereBothAre) {
  // Density at the product of a highlight and a sun inside it, against either alone.
  EnvironmentMixture sky;
  sky.center = {kFrame.to_world(glm::normalize(Vec3(0.6f, 0.05f, 0.7f))), kFrame.to_world({-0.8f, 0, 0.6f})};
  sky.bandwidth = {3000, 3000};
  sky.coefficient = {Rgb(1.0f), Rgb(1.0f)};
  const LobeMixture mixture = proposal(sky);
  EXPECT_GT(test::mixture_density(mixture, sky.center[0]), 20 * test::mixture_density(mixture, sky.center[1]));
}

// The lights draw a sun's texels exactly: only a highlight about as sharp as the sun is multiplied with it.
TEST(ProductSampling, LeavesASunToTheLights) {
  EnvironmentMixture sky;
  sky.center = {kFrame.to_world(glossy().lobe[0].center), kFrame.z};
  sky.bandwidth = {1e5f, 2.0f};
  sky.coefficient = {Rgb(1e6f), Rgb(1.0f)};
  ASSERT_TRUE(EnvironmentProposals(sky).has_sun());
  EXPECT_LT(test::mixture_density(proposal(sky), sky.center[0]), 10);
  ProposalLobes mirror = glossy();
  mirror.lobe[0].bandwidth = 1e5f;
  EXPECT_GT(test::mixture_density(proposal(sky, mirror), sky.center[0]), 1000);
  sky.coefficient[0] = Rgb(1.0f);
  EXPECT_FALSE(EnvironmentProposals(sky).has_sun());
}

TEST(ProductSampling, ASkyOfBadFitBlursEdges) {
  const EnvironmentMixture sky = sky_of(20, 100);
  EXPECT_FALSE(EnvironmentProposals(sky, 0.1).blurs_edges());
  EXPECT_TRUE(EnvironmentProposals(sky, 0.3).blurs_edges());
  EXPECT_TRUE(EnvironmentProposals(sky, std::numeric_limits<double>::infinity()).blurs_edges());
}

// Light sampling takes over for diffuse materials only: a highlight blurs edges itself.
TEST(ProductSampling, LightsTakeOverWhereTheMaterialIsBroad) {
  const auto part = [](float bandwidth, double misfit) {
    Scene scene;
    scene.add_material({test::highlight_material(bandwidth), Rgb(0.0f), true});
    return lights_parts(scene, EnvironmentProposals(sky_of(20, 100), misfit)).at(0);
  };
  EXPECT_EQ(part(2, 0.1), 0.0f);
  EXPECT_EQ(part(2, 0.3), 0.5f);
  EXPECT_EQ(part(200, 0.3), 0.0f);
}

TEST(ProductSampling, NothingToProposeBelowTheHorizon) {
  EnvironmentMixture sky;
  sky.center = {-kFrame.z};
  sky.bandwidth = {1e5f};
  sky.coefficient = {Rgb(1.0f)};
  LobeMixture mixture;
  LobeProducts scratch;
  EXPECT_FALSE(EnvironmentProposals(sky).propose(glossy(), kFrame, scratch, mixture));
  EXPECT_FALSE(EnvironmentProposals({}).propose(glossy(), kFrame, scratch, mixture));
}

/// Two spheres that shade each other, of a material that has lobes, under an uneven sky and a lamp.
Scene pair(Environment environment, bool lamp, float bandwidth = 50) {
  Scene scene;
  scene.add_mesh(test::sphere(24));
  scene.add_material({test::highlight_material(bandwidth), Rgb(0.0f), true});
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

/// Small lamps with edges, which the fitted mixture blurs.
Environment softboxes() {
  constexpr size_t kWidth = 256;
  std::vector<float> pixels(3 * kWidth * kWidth / 2, 0.02f);
  for (size_t y = 36; y < 44; ++y) {
    for (size_t x = 0; x < kWidth; x += 32) {
      std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(3 * (kWidth * y + x)), 3 * 8, 30.0f);
    }
  }
  return Environment::image({kWidth, kWidth / 2, 3, pixels}, 1, Mat3(1.0f));
}

class ProductStrategy : public ::testing::Test {
 protected:
  void SetUp() override { skies_ = test::scratch_folder().string(); }

  test::PictureMeans measure(const Scene& scene, Strategy strategy, int split = 8) const {
    RenderOptions options = test::small_options(strategy, 256);
    options.split = split;
    options.cache_folder = skies_;
    return test::independent_renders(scene, options, 24, 1000 * static_cast<uint64_t>(strategy));
  }

  std::string skies_;
};

TEST_F(ProductStrategy, AgreesWithMisForEverySplit) {
  test::ZTests tests;
  for (const bool lamp : {false, true}) {
    const Scene scene = pair(uneven(1), lamp);
    const auto mis = measure(scene, Strategy::mis);
    for (const int split : {1, 3, 8}) {
      if (split == 3 && !test::long_tests()) continue;
      compare(std::string(lamp ? "lamp " : "") + std::to_string(split), measure(scene, Strategy::product, split), mis,
              tests);
    }
  }
  EXPECT_TRUE(tests.agree());
}

TEST_F(ProductStrategy, AgreesUnderSoftboxesThatTheLightsDraw) {
  const Progress progress;
  const EnvironmentMixture sky = mixture_of_environment(softboxes(), {}, "", progress);
  const Scene scene = pair(softboxes(), false, 2.0f);
  ASSERT_GT(lights_parts(scene, EnvironmentProposals(sky, misfit_of_environment(softboxes(), sky))).at(0), 0.0f);
  test::ZTests tests;
  for (const int split : {1, 8}) {
    compare(std::to_string(split), measure(scene, Strategy::product, split), measure(scene, Strategy::mis), tests);
  }
  EXPECT_TRUE(tests.agree());
}

TEST_F(ProductStrategy, NegativeControlASkyFivePercentBrighterIsSeen) {
  test::ZTests tests;
  compare("brighter", measure(pair(uneven(1.05f), false), Strategy::product),
          measure(pair(uneven(1), false), Strategy::mis), tests);
  EXPECT_TRUE(tests.differ());
}

TEST_F(ProductStrategy, UnderAConstantSkyToo) {
  const Scene scene = pair(Environment::constant(Rgb(1.0f)), false);
  test::ZTests tests;
  compare("constant", measure(scene, Strategy::product), measure(scene, Strategy::cosine), tests);
  EXPECT_TRUE(tests.agree());
}

}  // namespace
}  // namespace velour::product_sampling_test
