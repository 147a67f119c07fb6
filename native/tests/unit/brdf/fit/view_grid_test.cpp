#include "brdf/fit/slice_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/held_out.h"

namespace velour::view_grid_test {
namespace {

double polar_degrees(const Vec3& w) { return std::acos(std::min(1.0, static_cast<double>(w.z))) * 180 / kPiD; }

double distance_to_held_out(const Vec3& view) {
  double least = 90;
  for (const int degrees : kHeldOutViews) least = std::min(least, std::abs(polar_degrees(view) - degrees));
  return least;
}

TEST(ViewGrid, NoViewLiesWithinTheMargin) {
  for (const auto& views : {meridian_views(false), hemisphere_views(false)}) {
    for (const Vec3& v : views) EXPECT_GE(distance_to_held_out(v), kHeldOutMargin);
  }
}

TEST(ViewGrid, AllDataUsesTheHeldOutViews) {
  double least = 90;
  for (const Vec3& v : meridian_views(true)) least = std::min(least, distance_to_held_out(v));
  EXPECT_LT(least, 1e-3);
}

TEST(ViewGrid, TheMeridianIsSortedAndHasNoGaps) {
  const auto views = meridian_views(false);
  EXPECT_EQ(views.front(), Vec3(0, 0, 1));
  for (size_t i = 1; i < views.size(); ++i) {
    EXPECT_EQ(views[i].y, 0);
    const double step = polar_degrees(views[i]) - polar_degrees(views[i - 1]);
    EXPECT_GT(step, 0.05);
    EXPECT_LT(step, 2.2);
  }
}

TEST(LightGrid, IsAQuadratureOfTheHemisphere) {
  for (const float theta : {0.0f, 30.0f, 60.0f, 85.0f}) {
    const LightGrid grid = light_grid(direction(radians_from(theta), 0.7f));
    double area = 0, cosine = 0;
    for (size_t i = 0; i < grid.wl.size(); ++i) {
      EXPECT_GT(grid.wl[i].z, 0);
      area += grid.weight[i];
      cosine += static_cast<double>(grid.weight[i] * grid.wl[i].z);
    }
    // The edge at the horizon is a staircase of cells, the cosine is 0 there.
    EXPECT_NEAR(area, 2 * kPiD, 0.03 * 2 * kPiD) << theta;
    EXPECT_NEAR(cosine, kPiD, 0.005 * kPiD) << theta;
  }
}

TEST(LightGrid, HeldOutLightsLeaveTheirSolidAngleToTheirRing) {
  LightGrid grid = light_grid(direction(0.5f, 0));
  double before = 0, after = 0;
  std::vector<uint8_t> kept(grid.wl.size());
  for (size_t i = 0; i < kept.size(); ++i) {
    kept[i] = !held_out_light(i);
    before += grid.weight[i];
  }
  redistribute_weights(grid, kept);
  for (size_t i = 0; i < kept.size(); ++i) after += kept[i] ? grid.weight[i] : 0.0;
  EXPECT_NEAR(after, before, 1e-3 * before);
}

TEST(HeldOut, IsOneInEight) {
  int lights = 0, samples = 0;
  for (uint64_t i = 0; i < 80000; ++i) lights += held_out_light(i), samples += held_out_sample(i);
  EXPECT_NEAR(lights, 10000, 400);
  EXPECT_NEAR(samples, 10000, 400);
}

TEST(ReportedViews, SamplesCountForTheNearest) {
  const auto view_of = [](float degrees) { return reported_view_of(direction(radians_from(degrees), 1.0f)); };
  EXPECT_EQ(view_of(0), 5);
  EXPECT_EQ(view_of(12.4f), 5);
  EXPECT_EQ(view_of(17), -1);
  EXPECT_EQ(view_of(79), 75);
  EXPECT_EQ(view_of(81), 85);
}

}  // namespace
}  // namespace velour::view_grid_test
