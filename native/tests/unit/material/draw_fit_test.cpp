#include "material/draw_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "srbf/kernel.h"

namespace velour {
namespace {

WarpedLobe half_lobe(double bandwidth) { return {LobeSpace::half, {}, {0, 0, 1}, bandwidth, Vec3d(1)}; }
WarpedLobe light_lobe(double bandwidth, const Vec3d& center) {
  return {LobeSpace::light, {}, glm::normalize(center), bandwidth, Vec3d(1)};
}

Vec3d view_at(double degrees) { return {std::sin(radians_from(degrees)), 0, std::cos(radians_from(degrees))}; }

double total(const DrawFit& fit) {
  double sum = fit.cosine;
  for (const DrawnLobe& lobe : fit.lobes) sum += lobe.probability;
  return sum;
}

// As well as 64 points a component tell.
TEST(DrawFit, ASharpLobeIsDrawnAsItIs) {
  for (const double bandwidth : {1e3, 1e5, 1e6}) {
    for (const auto& lobe : {half_lobe(bandwidth), light_lobe(bandwidth, {0.5, 0.2, 0.8})}) {
      const DrawFit fit = fit_draws({&lobe, 1}, view_at(30));
      EXPECT_NEAR(fit.lobes[0].bandwidth, bandwidth, 0.05 * bandwidth);
      EXPECT_LT(glm::distance(fit.lobes[0].center, lobe.center), 0.2 / std::sqrt(bandwidth));
      EXPECT_GT(fit.lobes[0].probability, 0.98);
      EXPECT_NEAR(total(fit), 1, 1e-12);
    }
  }
}

// f cos of a narrow lobe about `center`: its integral times the cosine there; in half space times 4 (wv . h).
TEST(DrawFit, MassIsTheIntegralOfFCos) {
  const WarpedLobe light = light_lobe(1e4, {0.5, 0.2, 0.8}), half = half_lobe(1e4);
  const double integral = kernel_integral(Kernel::gaussian, 1e4), cosine = std::cos(radians_from(40.0));
  EXPECT_NEAR(fit_draws({&light, 1}, view_at(40)).mass, integral * light.center.z, 0.02 * integral);
  EXPECT_NEAR(fit_draws({&half, 1}, view_at(40)).mass, 4 * cosine * cosine * integral, 0.02 * integral);
}

TEST(DrawFit, LobesThatTheHorizonCutsMoveAboveIt) {
  const WarpedLobe light = light_lobe(20, {-1, 0, -0.1}), half = half_lobe(200);
  const DrawFit cut = fit_draws({&light, 1}, view_at(70));
  EXPECT_GT(cut.lobes[0].center.z, 0.1);
  EXPECT_GT(cut.lobes[0].bandwidth, 20);
  // At 88 degrees half of the half vectors would be drawn for nothing: those that lean away from the viewer.
  EXPECT_GT(fit_draws({&half, 1}, view_at(88)).lobes[0].center.x, 0.03);
}

TEST(DrawFit, NearlyConstantLobesGiveWayToTheCosine) {
  for (const auto& lobe : {light_lobe(1e-4, {0, 0, 1}), half_lobe(1e-4), light_lobe(0.05, {0.6, 0, 0.8})}) {
    EXPECT_GT(fit_draws({&lobe, 1}, view_at(50)).cosine, 0.7);
  }
}

TEST(DrawFit, WithoutLightThereIsTheCosine) {
  WarpedLobe black = half_lobe(100);
  black.coefficient = Vec3d(0);
  EXPECT_EQ(fit_draws({&black, 1}, view_at(50)).cosine, 1);
  const WarpedLobe below = light_lobe(1e6, {0, 0, -1});
  for (const auto& fit : {fit_draws({}, view_at(0)), fit_draws({&below, 1}, view_at(0))}) EXPECT_EQ(fit.cosine, 1);
}

TEST(DrawFit, IsFiniteAtTheHorizon) {
  for (const double degrees : {89.0, 89.99, 90.0}) {
    for (const double bandwidth : {1e-4, 10.0, 1e6}) {
      const WarpedLobe lobes[] = {half_lobe(bandwidth), light_lobe(bandwidth, {-1, 0, 0}), half_lobe(bandwidth)};
      const DrawFit fit = fit_draws(lobes, view_at(degrees));
      EXPECT_NEAR(total(fit), 1, 1e-9);
      for (const DrawnLobe& lobe : fit.lobes) {
        EXPECT_TRUE(lobe.bandwidth > 0 && std::isfinite(lobe.bandwidth) && std::isfinite(lobe.light_bandwidth));
        EXPECT_NEAR(glm::length(lobe.center), 1, 1e-9);
        EXPECT_GE(lobe.probability, 0);
      }
    }
  }
}

}  // namespace
}  // namespace velour
