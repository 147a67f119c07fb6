#include "btf/fit/srbf/srbf_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace velour::side_shares_test {
namespace {

/// Each coefficient leaves `factor` of what was left before.
SideDemand demand(double energy, double factor, size_t count) {
  SideDemand side;
  side.energy = energy;
  for (size_t i = 0; i < count; ++i) {
    side.order.axis.push_back(0);
    side.order.left.push_back(std::pow(factor, static_cast<double>(i + 1)));
  }
  return side;
}

TEST(SideShares, OfOneSideAreItsOrder) {
  const std::vector<SideDemand> sides{demand(7, 0.25, 5)};
  const SideShares shares(sides, 100);
  ASSERT_EQ(shares.curve().points.size(), 5u);
  for (size_t i = 0; i < 5; ++i) {
    const OrderPoint& point = shares.curve().points[i];
    EXPECT_EQ(shares.at(i), std::vector<size_t>{i + 1});
    EXPECT_EQ(point.lobes, static_cast<int>(i + 1));
    EXPECT_NEAR(point.relative_l2, std::pow(0.5, static_cast<double>(i + 1)), 1e-12);
    EXPECT_EQ(point.parameter_bytes, srbf_side_bytes(100, i + 1, i + 1));
  }
}

/// The bytes go where they are needed: a dim side gets few, and one that its first coefficient explains gets no more.
TEST(SideShares, GoWhereTheyLeaveTheLeast) {
  const std::vector<SideDemand> sides{demand(100, 0.7, 40), demand(1, 0.7, 40), demand(100, 1e-9, 40)};
  const SideShares shares(sides, 100);
  const std::vector<size_t> at = shares.at(20);
  EXPECT_EQ(std::accumulate(at.begin(), at.end(), size_t{0}), 23u);
  EXPECT_NEAR(static_cast<double>(at[0]) - static_cast<double>(at[1]), std::log(100) / std::log(1 / 0.7), 1);
  EXPECT_EQ(at[2], 1u);
}

TEST(SideShares, OfBlackHaveNoError) {
  const std::vector<SideDemand> sides{demand(0, 0, 1)};
  EXPECT_EQ(SideShares(sides, 4).curve().points.at(0).relative_l2, 0.0);
}

}  // namespace
}  // namespace velour::side_shares_test
