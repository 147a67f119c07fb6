// sample_mixture against the density that eval_mixture and eval_density claim: one lobe of any bandwidth anywhere, and
// mixtures.
#include <sstream>

#include "support/lobe_cells.h"

namespace velour::lobe_sampling_test {
namespace {

using test::Sampler;

LobeMixture one_lobe(Kernel kernel, const Vec3& center, float bandwidth) {
  LobeMixture mixture;
  mixture.clear(kernel);
  mixture.add(center, bandwidth, {1, 1, 1});
  mixture.finish(0);
  return mixture;
}

const Vec3 kCenters[] = {{0, 0, 1},
                         glm::normalize(Vec3(1, -2, 1.5f)),
                         glm::normalize(Vec3(-1, 0.5f, 0.01f)),
                         glm::normalize(Vec3(0.2f, -1, -1e-4f)),
                         {0, 0, -1}};

struct LobeCase {
  Kernel kernel;
  float bandwidth;
  int center;
};

void PrintTo(const LobeCase& c, std::ostream* out) {
  *out << kernel_name(c.kernel) << ' ' << c.bandwidth << " about center " << c.center;
}

std::vector<LobeCase> lobe_cases() {
  std::vector<LobeCase> cases;
  for (int center = 0; center < 5; ++center) {
    for (const float b : {1e-4f, 1e-3f, 1e-2f, 0.1f, 1.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e5f, 1e6f}) {
      cases.push_back({Kernel::gaussian, b, center});
    }
    for (const float b : {1e-4f, 1e-2f, 0.3f, 0.8f, 0.95f, 0.99f, 0.999f, 1 - 1e-4f}) {
      cases.push_back({Kernel::abel_poisson, b, center});
    }
  }
  // A millionth of a radian wide: only about the axes do float directions lie close enough to resolve it.
  for (const float b : {1 - 1e-5f, 1 - 1e-6f}) {
    cases.push_back({Kernel::abel_poisson, b, 0});
    cases.push_back({Kernel::abel_poisson, b, 4});
  }
  return cases;
}

class LobeSampling : public ::testing::TestWithParam<LobeCase> {};

TEST_P(LobeSampling, FollowsItsDensity) {
  const auto [kernel, bandwidth, center] = GetParam();
  test::expect_proven(test::mixture_sampler(one_lobe(kernel, kCenters[center], bandwidth)), "lobe");
}

INSTANTIATE_TEST_SUITE_P(All, LobeSampling, ::testing::ValuesIn(lobe_cases()));

TEST(LobeSamplingControl, ABandwidthOffByFivePercentIsSeen) {
  for (const float bandwidth : {3.0f, 1e3f, 1e6f}) {
    const auto sampler = [&](float b) { return test::mixture_sampler(one_lobe(Kernel::gaussian, kCenters[1], b)); };
    EXPECT_GT(test::p_value(sampler(bandwidth), sampler(bandwidth)), 1e-4) << bandwidth;
    EXPECT_LT(test::p_value(sampler(bandwidth), sampler(1.05f * bandwidth)), 1e-6) << bandwidth;
  }
}

// The 24 bits of one number choose the component and the zenith: a million samples must not show their steps.
TEST(LobeSamplingFine, AMillionSamplesOfTheSharpestLobe) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const Sampler lobe =
        test::mixture_sampler(one_lobe(kernel, kCenters[1], kernel == Kernel::gaussian ? 1e6f : 0.999f));
    test::ChiSquareOptions options = test::proof_options(lobe);
    options.samples = 1'000'000;
    options.rows = 401;
    options.columns = 8;
    EXPECT_TRUE(test::follows_density(test::chi_square(lobe.sample, lobe.pdf, options), 0.005, kernel_name(kernel)));
  }
}

LobeMixture highlight_over_haze(Kernel kernel, float share) {
  LobeMixture mixture;
  mixture.clear(kernel);
  const bool gaussian = kernel == Kernel::gaussian;
  mixture.add(kCenters[2], gaussian ? 3e3f : 0.98f, gaussian ? Rgb(900, 700, 500) : Rgb(0.9f, 0.7f, 0.5f));
  mixture.add(glm::normalize(Vec3(1, 1, 2)), gaussian ? 12 : 0.7f, {0.5f, 1, 0});
  mixture.add({0, 0, 1}, gaussian ? 1 : 0.2f, {0.3f, 0.3f, 0.3f});
  mixture.add(kCenters[1], gaussian ? 100 : 0.9f, {0, 0, 0});  // black: never drawn
  mixture.finish(share);
  return mixture;
}

using MixtureCase = std::tuple<Kernel, float>;

class MixtureSampling : public ::testing::TestWithParam<MixtureCase> {};

TEST_P(MixtureSampling, FollowsTheWholeDensity) {
  const auto [kernel, share] = GetParam();
  test::expect_proven(test::mixture_sampler(highlight_over_haze(kernel, share)), "mixture");
}

TEST_P(MixtureSampling, ManyLobesFollowTheWholeDensity) {
  const auto [kernel, share] = GetParam();
  LobeMixture mixture;
  mixture.clear(kernel);
  RandomStream random(9, 0, 0);
  for (const Vec3& center : hemisphere_fibonacci(LobeMixture::kCapacity)) {
    mixture.add(center, kernel == Kernel::gaussian ? 5 + 60 * random.next() : 0.5f + 0.3f * random.next(),
                Rgb(random.next()));
  }
  mixture.finish(share);
  Sampler sampler = test::mixture_sampler(mixture);
  sampler.axis = {0, 0, 1};
  sampler.concentration = 0;
  test::expect_proven(sampler, "many lobes");
}

INSTANTIATE_TEST_SUITE_P(Shares, MixtureSampling,
                         ::testing::Combine(::testing::Values(Kernel::gaussian, Kernel::abel_poisson),
                                            ::testing::Values(0.0f, 0.05f, 0.5f)));

TEST(MixtureSamplingControl, ADensityWithoutTheCosineIsSeen) {
  EXPECT_LT(test::p_value(test::mixture_sampler(highlight_over_haze(Kernel::gaussian, 0.05f)),
                          test::mixture_sampler(highlight_over_haze(Kernel::gaussian, 0))),
            1e-9);
}

}  // namespace
}  // namespace velour::lobe_sampling_test
