// The Sobol sequence, the combinations of `mis` and the noise estimate against independent numbers.
#include <gtest/gtest.h>

#include "support/gallery.h"
#include "support/renders.h"

namespace velour::sequences_test {
namespace {

TEST(Combinations, EveryShareAndHeuristicHasTheSameExpectation) {
  const Scene scene = test::gallery();
  const auto expected = test::independent_renders(scene, test::small_options(Strategy::mis, 512), 20, 1000);
  test::ZTests tests;
  for (Sequence sequence : {Sequence::random, Sequence::sobol}) {
    for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
      for (float share : {0.1f, 0.37f, 0.9f, 1.0f}) {
        RenderOptions options = test::small_options(Strategy::mis, 96);
        options.split = 3;
        options.sequence = sequence;
        options.heuristic = heuristic;
        options.light_share = share;
        const std::string name = std::to_string(static_cast<int>(sequence)) + ' ' +
                                 std::to_string(static_cast<int>(heuristic)) + ' ' + std::to_string(share);
        compare(name, test::independent_renders(scene, options, 20, 0), expected, tests);
      }
    }
  }
  EXPECT_TRUE(tests.agree());
}

/// A rough plane that fills the picture, under a smooth sky.
Scene smooth() {
  Scene scene;
  scene.add_mesh(test::square(100));
  scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  std::vector<float> pixels(3 * 8 * 4);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = 1 + static_cast<float>(i % 24) / 24;
  scene.set_environment(Environment::image({8, 4, 3, pixels}, 1, Mat3(1.0f)));
  scene.set_camera(test::camera_above(0.01f));
  scene.commit(2);
  return scene;
}

/// Variance of a pixel's green over seeds, mean over the pixels; and correlation between neighbors in a row.
struct Spread {
  double variance, neighbors;
};
Spread spread(const Scene& scene, RenderOptions options) {
  constexpr uint64_t kSeeds = 40;
  std::vector<std::vector<float>> pictures;
  std::vector<test::RunningMean> pixels(64);
  for (options.seed = 0; options.seed < kSeeds; ++options.seed) {
    pictures.push_back(test::rendered(scene, options));
    for (size_t i = 0; i < 64; ++i) pixels[i].add(static_cast<double>(pictures.back()[4 * i + 1]));
  }
  double variance = 0, product = 0;
  for (const auto& p : pixels) variance += p.variance() / 64;
  for (const auto& picture : pictures) {
    const auto error = [&](size_t i) { return static_cast<double>(picture[4 * i + 1]) - pixels[i].mean(); };
    for (size_t i = 0; i + 1 < 64; ++i) product += error(i) * error(i + 1) / (63 * (kSeeds - 1));
  }
  return {variance, product / variance};
}

TEST(Sequences, SobolHasFarLessVarianceWhereTheIntegrandIsSmoothAndPixelsDoNotCorrelate) {
  const Scene scene = smooth();
  RenderOptions options = test::small_options(Strategy::mis, 256);
  const Spread sobol = spread(scene, options);
  options.sequence = Sequence::random;
  const Spread random = spread(scene, options);
  EXPECT_LT(sobol.variance, 0.25 * random.variance);
  EXPECT_LT(std::abs(sobol.neighbors), 4 / std::sqrt(63.0 * 40));
}

TEST(Sequences, SobolConvergesFasterThanOneOverN) {
  const Scene scene = smooth();
  const double few = spread(scene, test::small_options(Strategy::cosine, 64)).variance;
  const double many = spread(scene, test::small_options(Strategy::cosine, 1024)).variance;
  EXPECT_LT(many / few, 1.0 / 64);  // independent numbers: 1 / 16
}

TEST(NoiseTarget, WhatIsReportedIsTheTrueError) {
  // True error against a converged picture, over several seeds; the reported one must agree within a fifth.
  const Scene scene = test::gallery();
  RenderOptions options = test::small_options(Strategy::mis, 1 << 14);
  options.width = options.height = 32;
  options.seed = 77;
  const auto reference = test::rendered(scene, options);
  const auto luminance_of = [](const std::vector<float>& p, size_t i) {
    return static_cast<double>(luminance({p[4 * i], p[4 * i + 1], p[4 * i + 2]}));
  };
  double mean = 0;
  for (size_t i = 0; i < 1024; ++i) mean += luminance_of(reference, i) / 1024;
  for (Sequence sequence : {Sequence::random, Sequence::sobol}) {
    options.sequence = sequence;
    options.noise = 0.04;
    test::RunningMean claimed, true_sq;
    for (options.seed = 0; options.seed < 8; ++options.seed) {
      RenderReport report;
      const auto picture = test::rendered(scene, options, "Combined", &report);
      EXPECT_EQ(report.blocks_unfinished, std::optional<uint64_t>(0));
      EXPECT_LT(report.spp, uint64_t{1} << 14);
      claimed.add(report.noise);
      for (size_t i = 0; i < 1024; ++i) {
        const double error = luminance_of(picture, i) - luminance_of(reference, i);
        true_sq.add(error * error);
      }
    }
    EXPECT_NEAR(claimed.mean() / (std::sqrt(true_sq.mean()) / mean), 1, 0.2) << static_cast<int>(sequence);
  }
}

TEST(Mis, OddSplitsAreUnbiased) {
  const Scene scene = test::gallery();
  test::ZTests tests;
  RenderOptions options = test::small_options(Strategy::mis, 63);
  const auto even = test::independent_renders(scene, options, 40, 1000);
  for (int split : {1, 3}) {
    options.split = split;
    compare(std::to_string(split), test::independent_renders(scene, options, 40, 0), even, tests);
  }
  EXPECT_TRUE(tests.agree());
}

TEST(Mis, NoiseEstimateIsHonest) {
  // The spread of independent renders of one pixel against what each of them claims.
  const Scene scene = test::gallery();
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
}  // namespace velour::sequences_test
