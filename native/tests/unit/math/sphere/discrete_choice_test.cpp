#include "math/sphere/random.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace velour::discrete_choice_test {
namespace {

TEST(DiscreteChoice, AgreesWithLinearSearch) {
  for (int n = 1; n <= 40; ++n) {
    std::vector<float> cdf;
    for (int i = 1; i <= n; ++i) cdf.push_back(static_cast<float>(i / 3) / static_cast<float>(std::max(n / 3, 1)));
    cdf.back() = 1;
    for (int k = 0; k < 1000; ++k) {
      const double u = k / 1000.0;
      int expected = 0;
      while (cdf[static_cast<size_t>(expected)] <= u) ++expected;
      double rest = u;
      ASSERT_EQ(choose_index(cdf.data(), n, rest), expected) << n << ' ' << u;
      const double below = expected > 0 ? cdf[static_cast<size_t>(expected - 1)] : 0;
      ASSERT_NEAR(below + rest * (cdf[static_cast<size_t>(expected)] - below), u, 1e-12);
    }
  }
}

TEST(DiscreteChoice, NeverChoosesWhatHasNoProbability) {
  const float cdf[] = {0, 0.5f, 0.5f, 1, 1};
  for (const double u : {0.0, 0.25, 0.5, 0.75, 1 - 0x1p-25}) {
    double rest = u;
    const int i = choose_index(cdf, 5, rest);
    EXPECT_TRUE(i == 1 || i == 3) << u;
    EXPECT_GE(rest, 0);
    EXPECT_LT(rest, 1);
  }
}

TEST(DiscreteChoice, TheMiddleOfAStepStaysInside) {
  EXPECT_GT(middle_of_step(0), 0);
  EXPECT_LT(middle_of_step(1 - 0x1p-24f), 1);
}

}  // namespace
}  // namespace velour::discrete_choice_test
