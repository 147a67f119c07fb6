// How finely surfaces are seen, and which resolution that asks for.
#include "usage/scene_domain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "usage/observation.h"

namespace velour::surface_domain_test {
namespace {

/// Weight 1 at each of these widths of a look-up, as shares of the tile's side.
SurfaceDomain seen_with_widths(const std::vector<double>& widths) {
  SurfaceDomain domain;
  for (const double w : widths) add_seen(domain, static_cast<float>(std::log2(w * 65536)), Vec2(0.5f), 1);
  return domain;
}

TEST(SurfaceDomain, TheFinestLookUpIsKnownToAnEighthOfAnOctave) {
  for (const double width : {0.9, 0.3, 0.031, 1e-4, 2e-5}) {
    const double found = finest_footprint(seen_with_widths({width, 0.9}));
    EXPECT_GT(found, width * 0.9999);
    EXPECT_LE(found, width * std::exp2(0.1251)) << width;
  }
}

TEST(SurfaceDomain, WhatHardlyCountsIsLeftOut) {
  SurfaceDomain domain = seen_with_widths({0.25});
  add_seen(domain, 2, Vec2(0.5f), 0.9e-4);
  EXPECT_GT(finest_footprint(domain), 0.25);
  add_seen(domain, 2, Vec2(0.5f), 0.2e-4);
  EXPECT_LT(finest_footprint(domain), 1e-4);
}

TEST(SurfaceDomain, NothingSeenIsInfinitelyCoarseButCannotBeServed) {
  EXPECT_TRUE(std::isinf(finest_footprint({})));
  EXPECT_EQ(share_finer_than({}, 1 << 20), 1);
}

TEST(SurfaceDomain, ResolutionIsEnoughForItsOwnFinestLookUps) {
  const SurfaceDomain domain = seen_with_widths({1.0 / 32, 1.0 / 8, 1.0 / 8, 1.0 / 8});
  EXPECT_TRUE(resolves(64, finest_footprint(domain)));
  EXPECT_FALSE(resolves(32, finest_footprint(domain)));
  EXPECT_EQ(share_finer_than(domain, 64), 0);
  EXPECT_DOUBLE_EQ(share_finer_than(domain, 32), 0.25);
  EXPECT_DOUBLE_EQ(share_finer_than(domain, 8), 1);
}

TEST(SurfaceDomain, WidthsBeyondTheBinsCountAtTheirEnds) {
  SurfaceDomain domain;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float level : {-3.0f, nan}) add_seen(domain, level, Vec2(0.0f), 1);
  for (const float level : {40.0f, infinity}) add_seen(domain, level, Vec2(0.0f), 1);
  EXPECT_EQ(domain.footprint.front(), 2);
  EXPECT_EQ(domain.footprint.back(), 2);
}

TEST(SurfaceDomain, PlacesRepeatWithTheTile) {
  SurfaceDomain domain;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec2& uv : {Vec2(0.99f, 0.01f), Vec2(-5.01f, 7.01f), Vec2(0.999999f, 2.0f)}) add_seen(domain, 4, uv, 1);
  EXPECT_EQ(domain.tile[15], 3);
  EXPECT_EQ(seen_share_of_tile(domain), 1.0 / 256);
  add_seen(domain, 4, Vec2(nan, 0.5f), 1);
  EXPECT_EQ(seen_share_of_tile(domain), 2.0 / 256);
}

TEST(SurfaceDomain, FramesAddUp) {
  SurfaceDomain sum = seen_with_widths({0.1});
  merge(sum, seen_with_widths({0.01, 0.1}));
  EXPECT_EQ(sum.weight(), 3);
  EXPECT_NEAR(share_finer_than(sum, 64), 1.0 / 3, 1e-12);
}

TEST(OutOfResolution, AFrameWithoutTheMaterialIsNowhereOutside) {
  SceneObservation frame;
  EXPECT_EQ(out_of_resolution(1, frame), 0);
  frame.domain.view[3] = 1;  // seen, but nobody knows how finely
  EXPECT_EQ(out_of_resolution(1, frame), 1);
  frame.domain.surface = seen_with_widths({0.5});
  EXPECT_EQ(out_of_resolution(4, frame), 0);
  EXPECT_EQ(out_of_resolution(2, frame), 1);
}

TEST(OutOfViews, IsTheShareSeenFromElsewhere) {
  SceneDomain domain;
  SceneObservation frame;
  domain.view[3] = 1;
  EXPECT_EQ(out_of_views(domain, frame), 0);
  frame.domain.view[3] = 1;
  frame.domain.view[70] = 3;
  EXPECT_NEAR(out_of_views(domain, frame), 0.75, 1e-12);
  domain.view[68] = 1;
  EXPECT_EQ(out_of_views(domain, frame), 0);
}

}  // namespace
}  // namespace velour::surface_domain_test
