// The least size that is good enough, by few trials.
#include "usage/btf/scene_reduction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/sphere/random.h"

namespace velour::least_size_test {
namespace {

TEST(LeastSize, IsFoundToAFifthByFewTrials) {
  for (const size_t least : {0u, 1u, 7u, 60u, 333u, 5000u}) {
    int trials = 0;
    const size_t found = least_size(6000, [&](size_t size) {
      ++trials;
      return size >= least;
    });
    EXPECT_LE(trials, 2 + std::log2(static_cast<double>(least) + 1) + 2);
    EXPECT_GE(found, least);
    EXPECT_LE(static_cast<double>(found), 1.19 * static_cast<double>(least) + 1);
  }
}

TEST(LeastSize, FromTheEndOnNothingIsTried) {
  for (const size_t end : {0u, 1u, 2u, 3u, 10u, 64u, 100u}) {
    EXPECT_EQ(least_size(end,
                         [end](size_t size) {
                           EXPECT_LT(size, end);
                           return false;
                         }),
              end);
  }
}

/// Errors that fall with size, but not everywhere: fits of more lobes may well be worse.
TEST(LeastSize, NeverRisesWithTheErrorThatIsAllowed) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed, 0, 0);
    std::vector<double> error(400);
    for (size_t i = 0; i < error.size(); ++i) error[i] = std::exp(random.next()) / static_cast<double>(i + 1);
    size_t before = error.size();
    for (double allowed = 1e-3; allowed < 4; allowed *= 1.1) {
      const size_t end = error.size();
      const size_t found = least_size(end, [&](size_t size) { return error[size] <= allowed; });
      EXPECT_LE(found, before) << "seed " << seed;
      before = found;
    }
    EXPECT_EQ(before, 0u);
  }
}

}  // namespace
}  // namespace velour::least_size_test
