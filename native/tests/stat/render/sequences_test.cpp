// The Sobol sequence, the combinations of `mis` and the noise estimate against independent numbers.
#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/gallery.h"
#include "support/statistics.h"

namespace velour {
namespace {

test::RunningMean means(const Scene& scene, RenderOptions options, uint64_t seeds, uint64_t first_seed) {
  test::RunningMean mean;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    options.seed = first_seed + seed;
    mean.add(test::mean_of(test::rendered(scene, options), 1));
  }
  return mean;
}

double p_value(const test::RunningMean& a, const test::RunningMean& b) {
  return test::z_test(a.mean(), a.standard_error(), b.mean(), b.standard_error());
}

constexpr Strategy kAll[] = {Strategy::uniform, Strategy::cosine, Strategy::table,
                             Strategy::srbf,    Strategy::light,  Strategy::mis};

TEST(Sequences, EveryStrategyHasTheSameExpectation) {
  const Scene scene = test::gallery();
  const double level = test::sidak_level(0.01, 12);
  for (int bounces : {0, 2}) {
    for (Strategy strategy : kAll) {
      RenderOptions options = test::small_options(strategy, 100);  // the last camera ray has fewer directions
      options.bounces = bounces;
      options.sequence = Sequence::random;
      const auto judge = means(scene, options, 20, 1000);
      options.sequence = Sequence::sobol;
      EXPECT_GT(p_value(means(scene, options, 20, 0), judge), level) << static_cast<int>(strategy);
    }
  }
}

TEST(Sequences, NegativeControlABrighterSkyIsSeen) {
  const RenderOptions options = test::small_options(Strategy::mis, 100);
  EXPECT_LT(p_value(means(test::gallery(1.2f), options, 20, 0), means(test::gallery(), options, 20, 1000)), 1e-4);
}

TEST(Combinations, EveryShareAndHeuristicHasTheSameExpectation) {
  const Scene scene = test::gallery();
  const auto judge = means(scene, test::small_options(Strategy::mis, 512), 20, 1000);
  const double level = test::sidak_level(0.01, 16);
  for (Sequence sequence : {Sequence::random, Sequence::sobol}) {
    for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
      for (float share : {0.1f, 0.37f, 0.9f, 1.0f}) {
        RenderOptions options = test::small_options(Strategy::mis, 96);
        options.split = 3;
        options.sequence = sequence;
        options.heuristic = heuristic;
        options.light_share = share;
        EXPECT_GT(p_value(means(scene, options, 20, 0), judge), level)
            << static_cast<int>(sequence) << " " << static_cast<int>(heuristic) << " " << share;
      }
    }
  }
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

/// Variance of a pixel's green over seeds, mean over the pixels; and correlation between neighbours in a row.
struct Spread {
  double variance, neighbours;
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
  EXPECT_LT(std::abs(sobol.neighbours), 4 / std::sqrt(63.0 * 40));
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

}  // namespace
}  // namespace velour
