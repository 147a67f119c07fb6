// Every strategy converges to the same picture.
#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/gallery.h"
#include "support/statistics.h"

namespace velour {
namespace {

using test::gallery;

constexpr int kRegions = 4;
using Regions = std::array<test::RunningMean, kRegions>;

/// Means over the four quarters of the picture, by independent renders.
Regions measure(const Scene& scene, Strategy strategy, int bounces) {
  Regions regions;
  RenderOptions options = test::small_options(strategy, 128);
  options.bounces = bounces;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    options.seed = seed * 8 + static_cast<uint64_t>(strategy);
    const auto pixels = test::rendered(scene, options);
    std::array<double, kRegions> sums{};
    for (size_t i = 0; i < 64; ++i) sums[2 * (i / 32) + i % 8 / 4] += pixels[4 * i + 1] / 16;
    for (size_t r = 0; r < kRegions; ++r) regions[r].add(sums[r]);
  }
  return regions;
}

double least_p(const Regions& a, const Regions& b) {
  double least = 1;
  for (size_t r = 0; r < kRegions; ++r) {
    least = std::min(least, test::z_test(a[r].mean(), a[r].standard_error(), b[r].mean(), b[r].standard_error()));
  }
  return least;
}

class Strategies : public ::testing::TestWithParam<int> {};

TEST_P(Strategies, AgreeWithinTheirErrors) {
  const Scene scene = gallery();
  const Regions reference = measure(scene, Strategy::mis, GetParam());
  const double level = test::sidak_level(0.01, 8 * kRegions);
  for (Strategy s : {Strategy::uniform, Strategy::cosine, Strategy::table, Strategy::srbf, Strategy::light,
                     Strategy::ggx, Strategy::mis_ggx, Strategy::product}) {
    EXPECT_GT(least_p(measure(scene, s, GetParam()), reference), level) << static_cast<int>(s);
  }
}

TEST_P(Strategies, NegativeControlASkyTenPercentBrighterIsSeen) {
  const Regions a = measure(gallery(1.1f), Strategy::mis, GetParam());
  const Regions b = measure(gallery(), Strategy::mis, GetParam());
  EXPECT_LT(least_p(a, b), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(DirectAndIndirect, Strategies, ::testing::Values(0, 2));

TEST(Mis, OddSplitsAreUnbiased) {
  const Scene scene = gallery();
  for (int split : {1, 3}) {
    test::RunningMean odd, even;
    for (uint64_t seed = 0; seed < 40; ++seed) {
      RenderOptions options = test::small_options(Strategy::mis, 63);
      options.split = split;
      options.seed = seed;
      odd.add(test::mean_of(test::rendered(scene, options)));
      options.split = 8;
      options.seed = seed + 1000;
      even.add(test::mean_of(test::rendered(scene, options)));
    }
    EXPECT_GT(test::z_test(odd.mean(), odd.standard_error(), even.mean(), even.standard_error()), 0.005) << split;
  }
}

TEST(Mis, NoiseEstimateIsHonest) {
  // The spread of independent renders of one pixel against what each of them claims.
  const Scene scene = gallery();
  RenderOptions options = test::small_options(Strategy::mis, 128);
  options.noise = 1e-9;  // never reached: the sequences have two halves
  std::vector<test::RunningMean> pixels(64);
  test::RunningMean claimed;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    options.seed = seed;
    RenderReport report;
    const auto picture = test::rendered(scene, options, "Combined", &report);
    claimed.add(report.noise);
    for (size_t i = 0; i < 64; ++i) {
      pixels[i].add(static_cast<double>(luminance({picture[4 * i], picture[4 * i + 1], picture[4 * i + 2]})));
    }
  }
  double variance = 0, mean = 0;
  for (const auto& p : pixels) {
    variance += p.variance() / 64;
    mean += p.mean() / 64;
  }
  EXPECT_NEAR(claimed.mean() / (std::sqrt(variance) / mean), 1, 0.1);
}

}  // namespace
}  // namespace velour
