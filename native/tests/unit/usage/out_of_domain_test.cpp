// How much of a frame lies outside of a domain.
#include "usage/observation.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/example_observation.h"

namespace velour::out_of_domain_test {
namespace {

const ViewRange kAllViews;

/// Hits at `degrees`, one of weight 1 each, under light of density 1.
SceneObservation seen_at(const std::vector<float>& degrees) {
  SceneObservation frame;
  frame.domain.light_density = 1;
  for (const float d : degrees) {
    frame.hits.push_back({frame.hits.size(), direction(radians_from(d), 0), 0, 0, 0, 1});
    frame.domain.view[static_cast<size_t>(d)] += 1;
  }
  return frame;
}

TEST(OutOfDomain, AFrameLiesWithinItsOwnDomain) {
  const auto frame = test::example_observation(500);
  EXPECT_EQ(out_of_domain(frame.domain, kAllViews, frame), 0);
  // A range of whole bins leaves out 0.01 % of the weight at either end at most.
  EXPECT_LE(out_of_domain(frame.domain, view_range(frame.domain), frame), 2 * kOutside);
}

TEST(OutOfDomain, AFrameWithoutTheMaterialIsNowhereOutside) {
  SceneObservation frame;
  frame.domain.camera_rays = 65536;
  EXPECT_EQ(out_of_domain({}, {10, 20}, frame), 0);
}

TEST(OutOfDomain, ViewsCountByTheirWeight) {
  auto frame = seen_at({10.5f, 20.5f, 30.5f, 40.5f});
  frame.domain.view[40] = 7;
  const ViewRange range{15, 35};
  EXPECT_DOUBLE_EQ(out_of_domain(frame.domain, range, frame), 0.8);
}

TEST(OutOfDomain, SharperLightCountsByHits) {
  auto frame = seen_at({10.5f, 20.5f, 30.5f, 40.5f});
  frame.hits[1].light_density = static_cast<float>(kSharperLight) * 1.01f;
  frame.hits[2].light_density = static_cast<float>(kSharperLight) * 0.99f;
  const SceneDomain domain = seen_at({10.5f}).domain;
  EXPECT_DOUBLE_EQ(out_of_domain(domain, kAllViews, frame), 0.25);
}

TEST(OutOfDomain, AHitOutsideInBothWaysCountsOnce) {
  auto frame = seen_at({10.5f, 20.5f, 30.5f, 40.5f});
  for (const size_t i : {0u, 1u}) frame.hits[i].light_density = 100;
  const ViewRange range{15, 90};
  EXPECT_DOUBLE_EQ(out_of_domain(seen_at({10.5f}).domain, range, frame), 0.5);
}

TEST(OutOfDomain, LightWithoutExtentIsOutsideUnlessItWasSeen) {
  auto frame = seen_at({10.5f, 20.5f});
  frame.hits[1].light_density = std::numeric_limits<float>::infinity();
  SceneDomain domain = seen_at({10.5f}).domain;
  EXPECT_DOUBLE_EQ(out_of_domain(domain, kAllViews, frame), 0.5);
  domain.light_density = std::numeric_limits<double>::infinity();
  EXPECT_EQ(out_of_domain(domain, kAllViews, frame), 0);
}

}  // namespace
}  // namespace velour::out_of_domain_test
