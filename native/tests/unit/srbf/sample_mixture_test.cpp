#include <gtest/gtest.h>

#include "support/mixtures.h"

namespace velour {
namespace {

constexpr float kLast = 1 - 0x1p-24f;

TEST(SampleMixture, IsUnitAndFiniteAtTheEndsOfTheUnitSquare) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const float bandwidth : test::bandwidth_grid(kernel)) {
      for (const Vec3& center : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), glm::normalize(Vec3(1, -2, 1e-3f))}) {
        for (const float share : {0.0f, 0.05f}) {
          LobeMixture mixture;
          mixture.clear(kernel);
          mixture.add(center, bandwidth, {1, 2, 3});
          mixture.add(-center, bandwidth, {1e-6f, 0, 0});
          mixture.finish(share);
          for (const float u : {0.0f, 0x1p-24f, 0.049999997f, 0.05f, 0.5f, kLast}) {
            for (const float v : {0.0f, 0.25f, kLast}) {
              EXPECT_NEAR(glm::length(sample_mixture(mixture, {u, v})), 1, 5e-7f) << bandwidth << ' ' << u << ' ' << v;
            }
          }
        }
      }
    }
  }
}

// Every 24-bit number must fall where the whole interval puts it: the share of samples of each lobe is its
// probability.
TEST(SampleMixture, ChoosesLobesByTheirProbability) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  const auto centers = sphere_fibonacci(6);
  for (size_t j = 0; j < centers.size(); ++j) mixture.add(centers[j], 1e4f, Rgb(static_cast<float>(j)));
  mixture.finish(0);
  std::vector<int> found(centers.size());
  constexpr int kSteps = 1 << 16;
  for (int i = 0; i < kSteps; ++i) {
    int nearest;
    nearest_directions(centers, sample_mixture(mixture, {static_cast<float>(i) / kSteps, 0.5f}), 1, &nearest);
    ++found[static_cast<size_t>(nearest)];
  }
  for (size_t j = 0; j < centers.size(); ++j) {
    EXPECT_NEAR(found[j], kSteps * static_cast<double>(j) / 15, 1.5) << j;
  }
}

// The number left after the choice of a rare lobe still spreads over that lobe's zenith angles without bias.
TEST(SampleMixture, ZenithOfARareLobeIsNotQuantised) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  mixture.add({0, 0, 1}, 1, Rgb(1));
  mixture.add({0, 0, 1}, 1e6f, Rgb(2.0f));  // a few millionths of the mass
  mixture.finish(0);
  const double rare = 1 - mixture.cdf[0];
  ASSERT_LT(rare, 1e-5);
  const int steps = static_cast<int>(rare * 0x1p24);
  double sum = 0;
  for (int i = 1; i <= steps; ++i) {
    const Vec3 w = sample_mixture(mixture, {1 - static_cast<float>(i) * 0x1p-24f, 0.1f});
    sum += one_minus_dot(Vec3d(w), Vec3d(0, 0, 1)) * 1e6;
  }
  EXPECT_NEAR(sum / steps, 1, 0.05);  // mean of bandwidth x d under the lobe
}

}  // namespace
}  // namespace velour
