// sample_mixture against the density that eval_mixture claims.
#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/mixtures.h"

namespace velour {
namespace {

using test::ChiSquareOptions;
using test::ChiSquareResult;

double pdf_of(const LobeMixture& mixture, const Vec3& w) {
  RgbBatch value;
  ScalarBatch pdf;
  eval_mixture(mixture, test::batch_of({&w, 1}), value, pdf);
  return pdf.v[0];
}

ChiSquareResult judge(const LobeMixture& sampled, const LobeMixture& claimed, const ChiSquareOptions& options) {
  return test::chi_square([&](const Vec2& u) { return sample_mixture(sampled, u); },
                          [&](const Vec3& w) { return pdf_of(claimed, w); }, options);
}

LobeMixture one_lobe(Kernel kernel, const Vec3& center, float bandwidth) {
  LobeMixture mixture;
  mixture.clear(kernel);
  mixture.add(center, bandwidth, {1, 1, 1});
  mixture.finish(0);
  return mixture;
}

/// Cells that resolve a lobe: an Abel-Poisson kernel is as wide as a Gaussian of bandwidth b / (1 - b)^2.
ChiSquareOptions options_about(Kernel kernel, const Vec3& center, double bandwidth, int64_t samples) {
  ChiSquareOptions options;
  options.samples = samples;
  options.axis = center;
  const double sharpness = kernel == Kernel::gaussian ? bandwidth : bandwidth / ((1 - bandwidth) * (1 - bandwidth));
  options.concentration = sharpness > 3 ? sharpness : 0;
  return options;
}

const Vec3 kCenters[] = {{0, 0, 1},
                         glm::normalize(Vec3(1, -2, 1.5f)),
                         glm::normalize(Vec3(-1, 0.5f, 0.01f)),
                         glm::normalize(Vec3(0.2f, -1, -1e-4f)),
                         {0, 0, -1}};

void expect_all_pass(Kernel kernel, std::span<const float> bandwidths) {
  const int tests = static_cast<int>(bandwidths.size() * std::size(kCenters));
  const double level = test::sidak_level(0.01, tests);
  for (const float bandwidth : bandwidths) {
    for (const Vec3& center : kCenters) {
      const LobeMixture lobe = one_lobe(kernel, center, bandwidth);
      const ChiSquareResult result = judge(lobe, lobe, options_about(kernel, center, bandwidth, 200'000));
      EXPECT_EQ(result.problem, "") << bandwidth << ' ' << center.z;
      EXPECT_GT(result.p_value, level) << bandwidth << ' ' << center.z;
      EXPECT_NEAR(result.density_mass, 1, 2e-4) << bandwidth << ' ' << center.z;
    }
  }
}

TEST(LobeSampling, GaussianFollowsItsDensity) {
  expect_all_pass(Kernel::gaussian, std::vector{1e-4f, 0.5f, 8.0f, 60.0f, 1e3f, 1e5f, 1e6f});
}

TEST(LobeSampling, AbelPoissonFollowsItsDensity) {
  expect_all_pass(Kernel::abel_poisson, std::vector{1e-4f, 0.3f, 0.8f, 0.95f, 0.99f, 0.999f});
}

// The 24 bits of one number choose the component and the zenith: a million samples must not show their steps.
TEST(LobeSampling, AMillionSamplesOfTheSharpestLobe) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const float bandwidth = kernel == Kernel::gaussian ? 1e6f : 0.999f;
    const LobeMixture lobe = one_lobe(kernel, kCenters[1], bandwidth);
    ChiSquareOptions options = options_about(kernel, kCenters[1], bandwidth, 1'000'000);
    options.cos_theta_cells = 401;
    options.phi_cells = 8;
    const ChiSquareResult result = judge(lobe, lobe, options);
    EXPECT_EQ(result.problem, "");
    EXPECT_GT(result.p_value, 0.005);
  }
}

TEST(LobeSampling, RejectsABandwidthOffByFivePercent) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const float bandwidth = kernel == Kernel::gaussian ? 1e6f : 0.8f;
    const float wrong = kernel == Kernel::gaussian ? 1.05f * bandwidth : 0.81f;
    const ChiSquareResult result = judge(one_lobe(kernel, kCenters[1], bandwidth), one_lobe(kernel, kCenters[1], wrong),
                                         options_about(kernel, kCenters[1], bandwidth, 200'000));
    EXPECT_LT(result.p_value, 1e-9);
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

TEST(MixtureSampling, FollowsTheWholeDensity) {
  const double level = test::sidak_level(0.01, 6);
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const float share : {0.0f, 0.05f, 0.5f}) {
      const LobeMixture mixture = highlight_over_haze(kernel, share);
      ChiSquareOptions options = options_about(kernel, kCenters[2], mixture.bandwidth[0], 500'000);
      const ChiSquareResult result = judge(mixture, mixture, options);
      EXPECT_EQ(result.problem, "") << share;
      EXPECT_GT(result.p_value, level) << share;
      EXPECT_NEAR(result.density_mass, 1, 5e-4) << share;
    }
  }
}

TEST(MixtureSampling, ManyLobesFollowTheWholeDensity) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  RandomStream random(9, 0, 0);
  for (const Vec3& center : hemisphere_fibonacci(LobeMixture::kCapacity)) {
    mixture.add(center, 5 + 60 * random.next(), Rgb(random.next()));
  }
  mixture.finish(0.05f);
  ChiSquareOptions options;
  options.samples = 500'000;
  const ChiSquareResult result = judge(mixture, mixture, options);
  EXPECT_EQ(result.problem, "");
  EXPECT_GT(result.p_value, 0.005);
  EXPECT_NEAR(result.density_mass, 1, 1e-4);
}

TEST(MixtureSampling, RejectsADensityWithoutTheCosine) {
  const ChiSquareOptions options = options_about(Kernel::gaussian, kCenters[2], 3e3, 200'000);
  const ChiSquareResult result =
      judge(highlight_over_haze(Kernel::gaussian, 0.05f), highlight_over_haze(Kernel::gaussian, 0), options);
  EXPECT_LT(result.p_value, 1e-9);
}

}  // namespace
}  // namespace velour
