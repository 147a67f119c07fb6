#include "btf/measure/pair_layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace velour::held_out_pairs_test {
namespace {

TEST(HeldOutPairs, AreAlwaysTheSameAndFewerAreTheFirstOfMore) {
  const PairLayout some = held_out_pairs(64, false), more = held_out_pairs(100, false);
  EXPECT_EQ(some, held_out_pairs(64, false));
  ASSERT_EQ(some.pairs(), 64u);
  for (uint64_t pair = 0; pair < 64; ++pair) {
    EXPECT_EQ(some.view_of(pair), pair);
    EXPECT_EQ(some.light_of(pair), pair);
    EXPECT_EQ(some.views()[pair], more.views()[pair]);
    EXPECT_EQ(some.lights()[pair], more.lights()[pair]);
  }
}

TEST(HeldOutPairs, AreUniformOverTheCap) {
  constexpr double kCount = 4096;
  const PairLayout layout = held_out_pairs(4096, false);
  const double least = std::cos(radians_from(75.0));
  for (const auto* set : {&layout.views(), &layout.lights()}) {
    double cosines = 0, east = 0;
    for (const PolarAngles& d : *set) {
      EXPECT_LE(d.theta, 75);
      cosines += std::cos(radians_from(d.theta)) / kCount;
      east += (d.phi < 180 ? 1 : 0) / kCount;
    }
    EXPECT_NEAR(cosines, (1 + least) / 2, 4 * (1 - least) / std::sqrt(12 * kCount));
    EXPECT_NEAR(east, 0.5, 4 * 0.5 / std::sqrt(kCount));
  }
}

TEST(HeldOutPairs, OfTwoSidesAreTheSameMirroredByChance) {
  const PairLayout one = held_out_pairs(1024, false), two = held_out_pairs(1024, true);
  int below[2][2] = {};
  for (size_t i = 0; i < 1024; ++i) {
    const bool view = two.views()[i].theta > 90, light = two.lights()[i].theta > 90;
    ++below[view][light];
    EXPECT_NEAR(view ? 180 - two.views()[i].theta : two.views()[i].theta, one.views()[i].theta, 1e-12);
    EXPECT_EQ(two.lights()[i].phi, one.lights()[i].phi);
  }
  for (const auto& of_view : below) {
    for (const int count : of_view) EXPECT_NEAR(count, 256, 4 * std::sqrt(1024 * 0.25 * 0.75));
  }
}

TEST(HeldOutPairs, RefuseNoneAndTooMany) {
  EXPECT_THROW(held_out_pairs(0, false), Error);
  EXPECT_THROW(held_out_pairs(4097, false), Error);
}

}  // namespace
}  // namespace velour::held_out_pairs_test
