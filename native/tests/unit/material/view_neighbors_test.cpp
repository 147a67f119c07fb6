#include "brdf/eval/per_view_lobes.h"

#include <gtest/gtest.h>

#include <map>

#include "math/sphere/directions.h"

namespace velour::view_neighbors_test {
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
  EXPECT_EQ(ViewSearch({}, 4).nearest({0, 0, 1}).count, 0);
}

TEST(NearestViews, AHitStandsAlone) {
  const auto views = hemisphere_fibonacci(100);
  const ViewSearch search(views, 4);
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewNeighbors set = search.nearest(views[i]);
    ASSERT_EQ(set.count, 1);
    EXPECT_EQ(set.index[0], static_cast<int>(i));
    EXPECT_EQ(set.weight[0], 1);
  }
}

TEST(NearestViews, EquallyFarViewsShareEqually) {
  std::vector<Vec3> ring;
  for (int i = 0; i < 6; ++i) ring.push_back(direction(0.5f, static_cast<float>(i) * kPi / 3));
  const auto set = weights(ViewSearch(ring, 4).nearest({0, 0, 1}));
  EXPECT_GE(set.size(), 1u);
  EXPECT_EQ(weights(ViewSearch(std::span(ring).first(1), 4).nearest({0, 0, 1})).size(), 1u);
  EXPECT_EQ(weights(ViewSearch(std::span(ring).first(3), 4).nearest({0, 0, 1})).size(), 3u);
}

// A small step of the view must not make the weights jump, also where one view takes another's place.
TEST(NearestViews, WeightsAreContinuous) {
  const auto views = hemisphere_fibonacci(200);
  const ViewSearch search(views, 4);
  constexpr int kSteps = 40000;
  std::map<int, float> before;
  float largest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const float s = static_cast<float>(i) / kSteps;
    const auto now = weights(search.nearest(direction(0.1f + 1.2f * s, 5 * s)));
    for (const auto& [view, weight] : now) {
      const float old = before.contains(view) ? before[view] : 0;
      if (i > 0) largest = std::max(largest, std::abs(weight - old));
    }
    before = now;
  }
  EXPECT_LT(largest, 0.02f);
}

// The table must leave out no view that is among the nearest of any direction.
TEST(ViewSearch, FindsWhatReadingAllViewsFinds) {
  for (const int count : {1, 5, 40, 400}) {
    for (const int k : {1, 4, kMaxNeighbors}) {
      const auto views = hemisphere_fibonacci(count);
      const ViewSearch search(views, k);
      for (const Vec3& wv : sphere_fibonacci(20000)) {
        int all[kMaxNeighbors];
        const int nearest = nearest_directions(views, wv, k, all);
        const ViewNeighbors set = search.nearest(wv);
        // The weights of the last ones may be too small to keep.
        ASSERT_LE(set.count, nearest);
        for (int i = 0; i < set.count; ++i) ASSERT_EQ(set.index[i], all[i]) << count << ' ' << k;
      }
    }
  }
}

}  // namespace
}  // namespace velour::view_neighbors_test
