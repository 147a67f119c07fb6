#include "capture/tile/mesh_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace velour::periodic_noise_test {
namespace {

const PeriodicNoise kNoise{.seed = 5, .stream = 1, .cells = {7, 3}};

TEST(PeriodicNoise, Repeats) {
  for (double x : {0.0, 0.13, 0.5, 0.999}) {
    const double here = kNoise({x, 0.3});
    EXPECT_NEAR(kNoise({x + 1, 0.3}), here, 1e-9);
    EXPECT_NEAR(kNoise({x - 1, 1.3}), here, 1e-9);
  }
}

TEST(PeriodicNoise, IsSmoothAndStaysInItsRange) {
  constexpr double kStep = 1e-4;
  double low = 1, high = 0, before = kNoise({0, 0.2});
  for (double x = kStep; x < 1; x += kStep) {
    const double now = kNoise({x, 0.2});
    EXPECT_LT(std::abs(now - before), 1.5 * 7 * kStep);  // the steepest slope of the blend, times cells
    low = std::min(low, now);
    high = std::max(high, now);
    before = now;
  }
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1);
  EXPECT_GT(high - low, 0.3);
}

TEST(PeriodicNoise, AnotherSeedOrStreamIsAnotherNoise) {
  EXPECT_NE((PeriodicNoise{6, 1, {7, 3}}({0.2, 0.2})), kNoise({0.2, 0.2}));
  EXPECT_NE((PeriodicNoise{5, 2, {7, 3}}({0.2, 0.2})), kNoise({0.2, 0.2}));
}

}  // namespace
}  // namespace velour::periodic_noise_test
