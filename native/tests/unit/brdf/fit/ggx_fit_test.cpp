#include "brdf/fit/ggx_fit.h"

#include <gtest/gtest.h>

#include "brdf/fit/peer.h"
#include "material/material.h"
#include "material/microfacet/ggx.h"
#include "math/sphere/directions.h"
#include "support/analytic_measurement.h"
#include "support/test_data.h"

namespace velour::ggx_fit_test {
namespace {

using test::AnalyticMeasurement;

AnalyticMeasurement measurement_of(const GgxParameters& p) {
  return AnalyticMeasurement([p](const DirectionPair& w) { return ggx_model(p, w); }, p.alpha.x == p.alpha.y);
}

void expect_near(const GgxParameters& found, const GgxParameters& truth) {
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(found.alpha[k] / truth.alpha[k], 1, 2e-3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.diffuse[c], truth.diffuse[c], 2e-3);
    EXPECT_NEAR(found.f0[c], truth.f0[c], 0.01 * truth.f0[c]);
    EXPECT_NEAR(found.f90[c], truth.f90[c], 0.02);
  }
}

std::vector<GgxParameters> known_lobes() {
  return {{.alpha = Vec2(0.02f), .f0 = {0.9f, 0.6f, 0.3f}, .f90 = Rgb(1)},
          {.alpha = Vec2(0.3f), .f0 = {0.04f, 0.05f, 0.06f}, .f90 = Rgb(1), .diffuse = {0.4f, 0.1f, 0.02f}},
          {.alpha = Vec2(0.8f), .f0 = Rgb(0.5f), .f90 = {0.2f, 0.5f, 0.9f}, .diffuse = {0, 0.2f, 0}},
          {.alpha = {0.1f, 0.4f}, .f0 = {0.9f, 0.6f, 0.3f}, .f90 = Rgb(1), .diffuse = Rgb(0.05f)},
          {.alpha = {0.25f, 0.06f}, .f0 = Rgb(0.5f), .f90 = Rgb(1)}};
}

TEST(GgxFit, RecoversKnownLobesFromMeasurementsAndMaterials) {
  Progress progress;
  for (const GgxParameters& truth : known_lobes()) {
    SCOPED_TRACE(truth.alpha.x);
    expect_near(fit_ggx(measurement_of(truth), 2, progress), truth);
    expect_near(fit_ggx(*make_ggx_material(truth), 2, progress), truth);
  }
}

TEST(GgxFit, NegativeControlAnotherRoughnessIsNotFound) {
  Progress progress;
  const GgxParameters truth = known_lobes()[0];
  const GgxParameters found = fit_ggx(measurement_of(truth), 2, progress);
  EXPECT_GT(std::abs(found.alpha.x / (1.05f * truth.alpha.x) - 1), 0.02f);
}

TEST(GgxFit, DoesNotDependOnThreads) {
  const auto measurement = AnalyticMeasurement(test::ggx(0.2f, 0.1f), false);
  Progress progress;
  const GgxParameters one = fit_ggx(measurement, 1, progress), two = fit_ggx(measurement, 2, progress);
  EXPECT_EQ(one.alpha, two.alpha);
  EXPECT_EQ(one.f0, two.f0);
  EXPECT_EQ(one.f90, two.f90);
  EXPECT_EQ(one.diffuse, two.diffuse);
}

TEST(GgxFit, LambertIsAllDiffuse) {
  Progress progress;
  const GgxParameters p = fit_ggx(AnalyticMeasurement(test::lambert), 2, progress);
  EXPECT_NEAR(p.diffuse.r, 0.5f, 0.01f);
  EXPECT_LT(judge_peer(AnalyticMeasurement(test::lambert), Peer::ggx, 2, progress).error.relative_l2, 0.01);
}

TEST(GgxFit, BlackAndUncoveredDataGiveABlackLobe) {
  Progress progress;
  AnalyticMeasurement black([](const DirectionPair&) { return Rgb(0); });
  EXPECT_EQ(fit_ggx(black, 1, progress).diffuse, Rgb(0));
  AnalyticMeasurement nothing(test::lambert);
  nothing.set_coverage([](const DirectionPair&) { return false; });
  EXPECT_EQ(fit_ggx(nothing, 1, progress).f0, Rgb(0));
}

TEST(GgxFit, StopsAtACancel) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_ggx(AnalyticMeasurement(test::lambert), 2, progress), Error);
}

TEST(GgxFit, JudgesItselfAsAnyModelIsJudged) {
  Progress progress;
  const PeerFit exact = judge_peer(measurement_of(known_lobes()[1]), Peer::ggx, 2, progress);
  EXPECT_LT(exact.error.relative_l2, 2e-3);
  EXPECT_EQ(exact.error.by_view_angle.size(), 5u);
  // Two highlights are not one.
  const auto narrow = test::ggx(0.05f, 0.05f), broad = test::ggx(0.5f, 0.5f);
  const AnalyticMeasurement two([=](const DirectionPair& w) { return narrow(w) + 2.0f * broad(w); });
  EXPECT_GT(judge_peer(two, Peer::ggx, 2, progress).error.relative_l2, 0.05);
}

TEST(GgxFit, FollowsARealPaint) {
  VELOUR_NEED_DATA(path, "brdf/paper_white_rgb.bsdf");
  Progress progress;
  const auto fit = judge_peer(*load_measurement(path.string()), Peer::ggx, 2, progress);
  EXPECT_LT(fit.error.relative_l2, 0.08);
  EXPECT_GT(luminance(std::get<GgxParameters>(fit.parameters).diffuse), 0.6f);
}

// The descent must end where no small change helps: the minimum of the cost, not of a model of it.
TEST(GgxProblem, EndsAtAMinimumOfItsCost) {
  std::vector<PairSample> samples;
  const auto narrow = test::ggx(0.1f, 0.2f), broad = test::ggx(0.5f, 0.5f);
  for (const Vec3& wl : hemisphere_fibonacci(400)) {
    for (const float theta : {0.2f, 0.9f}) {
      const DirectionPair w{.wl = wl, .wv = direction(theta, 0.4f)};
      samples.push_back({w, wl.z * (narrow(w) + broad(w)), 1.0f});
    }
  }
  const GgxProblem problem({samples, 1e-3f}, false);
  const GgxParameters start = problem.completed({.alpha = Vec2(0.3f)});
  const GgxParameters p = descend(problem, start, [] {});
  const double least = problem.cost(p);
  EXPECT_LT(least, problem.cost(start));
  for (const float factor : {0.97f, 1.03f}) {
    for (int k = 0; k < 2; ++k) {
      GgxParameters other = p;
      other.alpha[k] *= factor;
      EXPECT_GT(problem.cost(other), least) << k;
    }
    for (int c = 0; c < 3; ++c) {
      for (auto member : {&GgxParameters::f0, &GgxParameters::f90, &GgxParameters::diffuse}) {
        GgxParameters other = p;
        (other.*member)[c] = std::max(0.0f, (other.*member)[c] + (factor - 1) * 0.5f);
        EXPECT_GE(problem.cost(other), least) << c;
      }
    }
  }
}

}  // namespace
}  // namespace velour::ggx_fit_test
