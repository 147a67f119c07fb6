#include "btf/measure/pair_layout.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sphere/directions.h"

namespace velour::pair_interpolation_test {
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

TEST(PairInterpolation, GoesOverTheLastRingWithoutAJump) {
  const std::vector<PolarAngles> set = bonn_directions();
  const PairInterpolation between(PairLayout(set, set));
  const auto weights_at = [&](float theta, float phi) {
    const auto corners = between.view(direction(radians_from(theta), radians_from(phi)));
    std::vector<float> weights(set.size());
    for (size_t k = 0; k < 3; ++k) weights[corners->index[k]] += corners->weight[k];
    return weights;
  };
  constexpr float kStep = 0.1f;  // degrees; a whole weight passes in the 15 between two rings
  for (const float phi : {0.0f, 3.3f, 7.5f, 100.0f}) {
    std::vector<float> before = weights_at(70, phi);
    for (float theta = 70; theta < 90; theta += kStep) {
      const std::vector<float> weights = weights_at(theta, phi);
      for (size_t v = 0; v < set.size(); ++v) EXPECT_NEAR(weights[v], before[v], 0.02f) << theta << ' ' << phi;
      before = weights;
    }
  }
}

TEST(PairInterpolation, NeedsEveryPair) {
  EXPECT_THROW(PairInterpolation(PairLayout(ring_directions(30, 2), ring_directions(50, 2), {{0, 1}, {0}})), Error);
}

}  // namespace
}  // namespace velour::pair_interpolation_test
