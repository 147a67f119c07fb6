#include "plot/pen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace velour::polyline_test {
namespace {

std::vector<Vec2> circle(int count) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const float a = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
    points.emplace_back(100 * std::cos(a), 100 * std::sin(a));
  }
  return points;
}

float distance(const Vec2& p, const std::vector<Vec2>& line) {
  float least = 1e9f;
  for (size_t i = 1; i < line.size(); ++i) {
    const Vec2 d = line[i] - line[i - 1];
    const float t = std::clamp(glm::dot(p - line[i - 1], d) / glm::dot(d, d), 0.0f, 1.0f);
    least = std::min(least, glm::length(p - line[i - 1] - t * d));
  }
  return least;
}

TEST(Polyline, WhatIsLeftIsCloseToAll) {
  const auto points = circle(5000);
  const auto few = simplified(points, 0.05f);
  EXPECT_LT(few.size(), 200u);
  EXPECT_EQ(few.front(), points.front());
  EXPECT_EQ(few.back(), points.back());
  for (const Vec2& p : points) EXPECT_LE(distance(p, few), 0.051f);
}

TEST(Polyline, ANarrowPeakIsKept) {
  std::vector<Vec2> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.1f * static_cast<float>(i), i == 500 ? 80.0f : 0.0f);
  const auto few = simplified(points, 0.05f);
  EXPECT_TRUE(std::ranges::find(few, Vec2(points[500])) != few.end());
}

TEST(Polyline, DashesAndGapsHaveTheirLengths) {
  const auto pieces = dashed({{0, 0}, {10, 0}, {10, 11}}, 3, 2);
  ASSERT_EQ(pieces.size(), 5u);  // 0-3, 5-8, 10-13, 15-18, 20-21
  EXPECT_EQ(pieces[1], (std::vector<Vec2>{{5, 0}, {8, 0}}));
  EXPECT_EQ(pieces[2].front(), Vec2(10, 0));
  EXPECT_NEAR(pieces[2].back().y, 3, 1e-4);
  EXPECT_NEAR(pieces[4].front().y, 10, 1e-4);
  EXPECT_NEAR(pieces[4].back().y, 11, 1e-4);
}

}  // namespace
}  // namespace velour::polyline_test
