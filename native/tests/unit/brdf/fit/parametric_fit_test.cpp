#include "brdf/fit/parametric/parametric_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/eval/parametric_material.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/held_out.h"
#include "support/analytic_measurement.h"
#include "support/level.h"

namespace velour::parametric_fit_test {
namespace {

using test::AnalyticMeasurement;

const ParametricBrdf& lobes_of(const Model& model) { return std::get<ParametricBrdf>(model.body); }

Model fitted(const Measurement& measurement, FitOptions options = {}) {
  Progress progress;
  return fit_parametric(measurement, options, progress);
}

void expect_tolerance_met(const Model& model, double tolerance) {
  for (const auto& [view, error] : model.fit.by_view_angle) {
    EXPECT_LE(error.value(), view == "85" ? 2 * tolerance : tolerance) << view;
  }
}

TEST(ParametricFit, ADiffuseMaterialIsOneLobe) {
  const Model model = fitted(AnalyticMeasurement(test::lambert));
  expect_tolerance_met(model, 0.02);
  EXPECT_LE(lobes_of(model).lobe_count(), 2);
  EXPECT_NEAR(model.fit.albedo_max, 0.5, 0.01);
}

TEST(ParametricFit, AGlossyMaterialMeetsTheToleranceAtGrazingViewsToo) {
  const Model model = fitted(AnalyticMeasurement(test::ggx(0.3f, 0.3f)));
  expect_tolerance_met(model, 0.02);
  EXPECT_LE(lobes_of(model).parameter_bytes(), 2700u);
}

TEST(ParametricFit, WhatIsDimBesideAHighlightIsFittedToo) {
  // A thousandth of the highlight: nothing to the squared error, half of the picture where no lamp is mirrored.
  const auto highlight = test::ggx(0.1f, 0.1f);
  const AnalyticMeasurement metal([highlight](const DirectionPair& p) { return highlight(p) + Rgb(0.01f); });
  const Model model = fitted(metal);
  expect_tolerance_met(model, 0.02);
  const auto material = make_parametric_material(std::make_shared<const ParametricBrdf>(lobes_of(model)));
  for (const float degrees : {20.0f, 45.0f, 65.0f}) {
    const Vec3 wv = direction(radians_from(degrees), 0.0f), wl = direction(radians_from(50.0f), 0.8f);
    Rgb f;
    evaluate(*material, wv, {&wl, 1}, {&f, 1});
    EXPECT_NEAR(f.g / (highlight({wl, wv}).g + 0.01f), 1, 0.2) << degrees;
  }
}

TEST(ParametricFit, StopsAtTheToleranceAndSaysHowItGrew) {
  FitOptions loose;
  loose.tolerance = 0.1;
  const Model few = fitted(AnalyticMeasurement(test::ggx(0.2f, 0.2f)), loose);
  const Model many = fitted(AnalyticMeasurement(test::ggx(0.2f, 0.2f)));
  EXPECT_LT(lobes_of(few).lobe_count(), lobes_of(many).lobe_count());
  const OrderCurve& order = many.fit.order;
  ASSERT_TRUE(order.chosen);
  EXPECT_EQ(order.points[*order.chosen].lobes, lobes_of(many).lobe_count());
  EXPECT_EQ(order.points[*order.chosen].parameter_bytes, lobes_of(many).parameter_bytes());
  for (size_t i = 1; i < order.points.size(); ++i) EXPECT_GT(order.points[i].lobes, order.points[i - 1].lobes);
}

TEST(ParametricFit, LobesAreBounded) {
  FitOptions options;
  options.max_lobes = 2;
  EXPECT_EQ(lobes_of(fitted(AnalyticMeasurement(test::ggx(0.1f, 0.1f)), options)).lobe_count(), 2);
}

TEST(ParametricFit, FollowsARetroReflectorToTheHorizon) {
  const AnalyticMeasurement retro([](const DirectionPair& p) {
    const float lobe = std::exp(1000 * (glm::dot(p.wl, p.wv) - 1));
    return Rgb(90, 80, 70) * lobe / std::max(p.wl.z, p.wv.z);
  });
  for (const auto& [view, error] : fitted(retro).fit.by_view_angle) EXPECT_LT(error.value(), 0.1) << view;
}

TEST(ParametricFit, IsReciprocalOnRequest) {
  // Darker towards the viewer's side than towards the light's: nothing symmetric can follow it.
  const auto half = test::ggx(0.3f, 0.3f);
  const AnalyticMeasurement odd([half](const DirectionPair& p) { return (0.5f + p.wv.z) * half(p); });
  const Model free = fitted(odd);
  EXPECT_GT(free.fit.reciprocity, 0.1);
  FitOptions options;
  options.symmetric = true;
  const Model symmetric = fitted(odd, options);
  EXPECT_TRUE(lobes_of(symmetric).symmetric);
  EXPECT_LT(symmetric.fit.reciprocity, 1e-4);
  EXPECT_GT(symmetric.fit.relative_l2, 2 * free.fit.relative_l2);  // the errors are those of the mean
}

TEST(ParametricFit, DoesNotDependOnThreads) {
  FitOptions one, two;
  one.max_lobes = two.max_lobes = 3;
  one.threads = 1;
  two.threads = 2;
  const AnalyticMeasurement measurement(test::ggx(0.25f, 0.25f));
  EXPECT_EQ(lobes_of(fitted(measurement, one)).control, lobes_of(fitted(measurement, two)).control);
}

TEST(ParametricFit, BrushedMetalHasStretchedLobes) {
  VELOUR_LONG_TEST();  // fits of anisotropic materials are among FailureModes, too
  FitOptions options;
  options.max_lobes = 4;
  const Model model = fitted(AnalyticMeasurement(test::ggx(0.15f, 0.4f), false), options);
  EXPECT_FALSE(lobes_of(model).isotropic);
  EXPECT_LE(model.fit.by_view_angle.at("30").value(), 0.06);
}

TEST(ParametricFit, BlackNeedsNoLobe) {
  const Model model = fitted(AnalyticMeasurement([](const DirectionPair&) { return Rgb(0); }));
  EXPECT_EQ(lobes_of(model).lobe_count(), 0);
}

TEST(ParametricFit, CancelEndsIt) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_parametric(AnalyticMeasurement(test::lambert), {}, progress), Error);
}

TEST(ParametricFit, RefusesSenselessOptions) {
  FitOptions options;
  options.max_lobes = 33;
  EXPECT_THROW(fitted(AnalyticMeasurement(test::lambert), options), Error);
}

TEST(SliceSampling, TheFoldIsWhatMirrorImagesDifferBy) {
  constexpr float kSkew = 0.1f;
  const auto skewed = [](float skew) {
    return AnalyticMeasurement([skew](const DirectionPair& p) {
      const float side = p.wv.x * p.wl.y - p.wv.y * p.wl.x;
      return Rgb(1 + (side > 0 ? skew : -skew));
    });
  };
  Progress progress;
  const SliceGrid grid{.parts = 64, .rings = 16, .spokes = 16, .folded = true};
  for (const float skew : {0.0f, kSkew}) {
    for (const MeasuredSlice& s : sample_slices(skewed(skew), grid, true, 1, progress).slices) {
      if (s.wv.x < 0.1f) continue;  // about the normal there is no plane of incidence
      const double expected = skew / std::sqrt(1 + skew * skew);
      EXPECT_NEAR(s.fold, expected, 0.02 * expected + 1e-6);
    }
  }
}

TEST(LobeGrowth, FitsThatShareTheirGrowthAreThoseOfTheirOwn) {
  Progress progress;
  const SliceGrid grid{.parts = 64, .rings = 16, .spokes = 16, .folded = true};
  const std::vector<MeasuredSlice> slices =
      sample_slices(AnalyticMeasurement(test::ggx(0.3f, 0.3f)), grid, true, 1, progress).slices;
  GrowthOptions options;
  options.cells = 2;
  options.tolerance = 0.002;
  LobeGrowth growth(slices, options, progress);
  for (const int most : {1, 3, 4, 5, 6}) {
    options.max_lobes = most;
    const GrowthResult shared = growth.fit(most), own = grow_lobes(slices, options, progress);
    EXPECT_EQ(shared.brdf.lobe_count(), most);
    EXPECT_EQ(shared.brdf.control, own.brdf.control);
    EXPECT_EQ(shared.order, own.order);
  }
}

TEST(SliceSampling, LeavesOutTheLightsThatJudge) {
  Progress progress;
  const SliceGrid grid{.parts = 64, .rings = 16, .spokes = 16};
  const AnalyticMeasurement measurement(test::lambert);
  const auto all = sample_slices(measurement, grid, false, 1, progress).slices;
  const auto fitted = sample_slices(measurement, grid, true, 1, progress).slices;
  ASSERT_EQ(fitted.size(), all.size());
  const std::span<const uint32_t> leaves = all[0].lights->leaves();
  ASSERT_EQ(all[0].samples.size(), leaves.size());
  const auto is_fitted = [&](const Vec3& wl) {
    return std::ranges::any_of(fitted[0].samples, [&](const SliceSample& s) { return s.wl == wl; });
  };
  size_t kept = 0;
  for (size_t i = 0; i < leaves.size(); ++i) {
    EXPECT_EQ(is_fitted(all[0].lights->cell(leaves[i]).wl), !held_out_light(i));
    kept += !held_out_light(i);
  }
  EXPECT_LT(kept, leaves.size());
  EXPECT_EQ(fitted[0].samples.size(), kept);
}

}  // namespace
}  // namespace velour::parametric_fit_test
