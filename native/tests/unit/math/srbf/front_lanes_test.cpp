#include "math/srbf/front_lanes.h"

#include <gtest/gtest.h>

#include <vector>

namespace velour::front_lanes_test {
namespace {

TEST(FrontLanes, AreThoseOfTheMaskInOrder) {
  for (size_t mask = 0; mask < 256; ++mask) {
    std::vector<int> expected;
    for (int i = 0; i < 8; ++i) {
      if ((mask >> i & 1) != 0) expected.push_back(i);
    }
    expected.resize(8, 0);
    EXPECT_EQ(std::vector<int>(kFrontLanes.lane[mask], kFrontLanes.lane[mask] + 8), expected);
  }
}

}  // namespace
}  // namespace velour::front_lanes_test
