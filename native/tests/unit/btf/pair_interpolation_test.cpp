#include "btf/pair_interpolation.h"

#include <gtest/gtest.h>

#include "job/error.h"
#include "sphere/directions.h"

namespace velour {
namespace {

TEST(PairInterpolation, GivesTheDirectionsOfTheSetBack) {
  std::vector<PolarAngles> views = bonn_directions();
  for (const PolarAngles& d : below(bonn_directions())) views.push_back(d);
  const PairInterpolation between(PairLayout(views, {{10, 20}}));
  for (uint32_t v = 0; v < views.size(); ++v) {
    const auto corners = between.view(unit_direction(views[v]));
    ASSERT_TRUE(corners);
    float own = 0;
    for (size_t k = 0; k < 3; ++k) own += corners->index[k] == v ? corners->weight[k] : 0.0f;
    EXPECT_NEAR(own, 1.0f, 1e-5f) << v;
  }
}

TEST(PairInterpolation, KeepsTheSidesApart) {
  const PairInterpolation between(PairLayout(bonn_directions(), below(bonn_directions())));
  EXPECT_TRUE(between.view({0, 0, 1}));
  EXPECT_FALSE(between.view({0, 0, -1}));
  EXPECT_FALSE(between.light({0, 0, 1}));
  EXPECT_TRUE(between.light({0, 0, -1}));
}

TEST(PairInterpolation, HoldsTheLastRingToTheHorizon) {
  const PairInterpolation between(PairLayout(bonn_directions(), bonn_directions()));
  for (const float theta : {80.0f, 89.9f, 90.0f}) {
    const auto corners = between.light(direction(radians_from(theta), 0.0f));
    for (size_t k = 0; k < 3; ++k) {
      if (corners->weight[k] == 0) continue;
      EXPECT_EQ(bonn_directions()[corners->index[k]].theta, 75) << theta;
    }
  }
}

TEST(PairInterpolation, NeedsEveryPair) {
  EXPECT_THROW(PairInterpolation(PairLayout(ring_directions(30, 2), ring_directions(50, 2), {{0, 1}, {0}})), Error);
}

}  // namespace
}  // namespace velour
