// From which directions a tile was seen.
#include "usage/scene_domain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/directions.h"
#include "usage/observation.h"

namespace velour::view_weights_test {
namespace {

Vec3 at(float theta, float phi) { return direction(radians_from(theta), radians_from(phi)); }
Vec3 mirrored(const Vec3& w) { return {w.x, w.y, -w.z}; }

ViewWeights seen_from(const std::vector<Vec3>& directions) {
  ViewWeights views;
  for (const Vec3& w : directions) add_view(views, w, 1);
  return views;
}

TEST(ViewWeights, DirectionsAreKnownToTheirBin) {
  for (const Vec3& w : hemisphere_fibonacci(2000)) {
    for (const Vec3& side : {w, mirrored(w)}) {
      const auto counted = counted_views(seen_from({side}));
      ASSERT_EQ(counted.size(), 1u);
      EXPECT_GE(dot(counted[0], side), std::cos(kBinRadius));
      EXPECT_GT(counted[0].z * side.z, 0);
    }
  }
}

TEST(ViewWeights, WhatHardlyCountsIsLeftOut) {
  ViewWeights views;
  add_view(views, at(45, 10), 1);
  add_view(views, at(45, 100), 0.4e-4);
  add_view(views, at(45, 200), 0.5e-4);
  EXPECT_EQ(counted_views(views).size(), 1u);
  add_view(views, at(45, 200), 0.5e-4);
  EXPECT_EQ(counted_views(views).size(), 2u);  // the lighter of both is within what may be left out
  EXPECT_TRUE(counted_views({}).empty());
}

TEST(ViewWeights, AnotherAzimuthIsElsewhere) {
  const ViewWeights known = seen_from({at(45, 2)});
  EXPECT_EQ(share_from_elsewhere(known, known), 0);
  EXPECT_EQ(share_from_elsewhere(known, seen_from({at(45, 7)})), 0);  // the next bin
  EXPECT_EQ(share_from_elsewhere(known, seen_from({at(45, 92)})), 1);
  EXPECT_EQ(share_from_elsewhere(known, seen_from({mirrored(at(45, 2))})), 1);
  EXPECT_EQ(share_from_elsewhere(from_both_sides(known), seen_from({mirrored(at(45, 2))})), 0);
  EXPECT_DOUBLE_EQ(share_from_elsewhere(known, seen_from({at(45, 2), at(50, 2), at(60, 2), at(20, 2)})), 0.5);
  EXPECT_EQ(share_from_elsewhere(known, {}), 0);
  EXPECT_EQ(share_from_elsewhere({}, known), 1);
}

TEST(ViewWeights, AtTheNormalAzimuthsAreOne) {
  EXPECT_EQ(share_from_elsewhere(seen_from({at(1, 0)}), seen_from({at(1, 180)})), 0);
}

TEST(ViewWeights, PolarAnglesAloneStandForAllAzimuthsOnBothSides) {
  SceneDomain domain;
  domain.view[47] = 3;
  EXPECT_NEAR(domain.directions().sum(), 3, 1e-12);
  for (const float phi : {0.0f, 77.0f, 300.0f}) {
    EXPECT_EQ(share_from_elsewhere(domain.directions(), seen_from({at(47, phi), mirrored(at(47, phi))})), 0);
  }
  EXPECT_EQ(share_from_elsewhere(domain.directions(), seen_from({at(60, 0)})), 1);
  add_view(domain.surface.views, at(47, 2), 3);
  EXPECT_EQ(share_from_elsewhere(domain.directions(), seen_from({at(47, 77)})), 1);
}

}  // namespace
}  // namespace velour::view_weights_test
