#include "material/view_neighbors.h"

#include <gtest/gtest.h>

#include <map>

#include "sphere/directions.h"

namespace velour {
namespace {

std::map<int, float> weights(const ViewNeighbors& set) {
  std::map<int, float> by_view;
  float sum = 0;
  for (int i = 0; i < set.count; ++i) {
    EXPECT_GT(set.weight[i], 0);
    by_view[set.index[i]] += set.weight[i];
    sum += set.weight[i];
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  return by_view;
}

TEST(BracketingViews, AreLinearInTheAngle) {
  const std::vector<float> theta{0.1f, 0.2f, 0.5f};
  const auto set = weights(bracketing_views(theta, 0.275f));
  EXPECT_NEAR(set.at(1), 0.75f, 1e-6);
  EXPECT_NEAR(set.at(2), 0.25f, 1e-6);
}

TEST(BracketingViews, HitsAndEndsStandAlone) {
  const std::vector<float> theta{0.1f, 0.2f, 0.5f};
  for (const auto& [angle, view] : std::map<float, int>{{0, 0}, {0.1f, 0}, {0.2f, 1}, {0.5f, 2}, {1.57f, 2}}) {
    const ViewNeighbors set = bracketing_views(theta, angle);
    EXPECT_EQ(set.count, 1) << angle;
    EXPECT_EQ(set.index[0], view) << angle;
    EXPECT_EQ(set.weight[0], 1) << angle;
  }
}

TEST(BracketingViews, OneViewOrEqualViewsOrNone) {
  EXPECT_EQ(bracketing_views(std::vector{0.3f}, 1).index[0], 0);
  weights(bracketing_views(std::vector{0.3f, 0.3f, 0.3f}, 0.3f));
  EXPECT_EQ(bracketing_views({}, 1).count, 0);
  EXPECT_EQ(nearest_views({}, {0, 0, 1}, 4).count, 0);
}

TEST(NearestViews, AHitStandsAlone) {
  const auto views = hemisphere_fibonacci(100);
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewNeighbors set = nearest_views(views, views[i], 4);
    ASSERT_EQ(set.count, 1);
    EXPECT_EQ(set.index[0], static_cast<int>(i));
    EXPECT_EQ(set.weight[0], 1);
  }
}

TEST(NearestViews, EquallyFarViewsShareEqually) {
  std::vector<Vec3> ring;
  for (int i = 0; i < 6; ++i) ring.push_back(direction(0.5f, static_cast<float>(i) * kPi / 3));
  const auto set = weights(nearest_views(ring, {0, 0, 1}, 4));
  EXPECT_GE(set.size(), 1u);
  EXPECT_EQ(weights(nearest_views(std::span(ring).first(1), {0, 0, 1}, 4)).size(), 1u);
  EXPECT_EQ(weights(nearest_views(std::span(ring).first(3), {0, 0, 1}, 4)).size(), 3u);
}

// A small step of the view must not make the weights jump, also where one view takes another's place.
TEST(NearestViews, WeightsAreContinuous) {
  const auto views = hemisphere_fibonacci(200);
  constexpr int kSteps = 40000;
  std::map<int, float> before;
  float largest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const float s = static_cast<float>(i) / kSteps;
    const auto now = weights(nearest_views(views, direction(0.1f + 1.2f * s, 5 * s), 4));
    for (const auto& [view, weight] : now) {
      const float old = before.contains(view) ? before[view] : 0;
      if (i > 0) largest = std::max(largest, std::abs(weight - old));
    }
    before = now;
  }
  EXPECT_LT(largest, 0.02f);
}

}  // namespace
}  // namespace velour
