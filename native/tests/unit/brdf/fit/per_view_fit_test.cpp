#include "brdf/fit/per_view/per_view_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <chrono>
#include <thread>

#include "brdf/eval/per_view_material.h"
#include "brdf/fit/error/compare.h"
#include "brdf/measure/held_out.h"
#include "support/analytic_measurement.h"
#include "support/warnings.h"

namespace velour::per_view_fit_test {
namespace {

using test::AnalyticMeasurement;

const PerViewBrdf& lobes_of(const Model& model) { return std::get<PerViewBrdf>(model.body); }

void expect_sound(const Model& model) {
  const PerViewBrdf& b = lobes_of(model);
  ASSERT_EQ(b.first_lobe.size(), b.views.size() + 1);
  EXPECT_EQ(b.first_lobe.back(), b.center.size());
  for (size_t j = 0; j < b.center.size(); ++j) {
    EXPECT_NEAR(glm::length(b.center[j]), 1, 1e-5);
    EXPECT_TRUE(std::isfinite(b.bandwidth[j]) && b.bandwidth[j] > 0);
    EXPECT_TRUE(b.kernel == Kernel::gaussian || b.bandwidth[j] < 1);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(b.coefficient[j][c]) && b.coefficient[j][c] >= 0);
  }
  EXPECT_TRUE(std::isfinite(model.fit.relative_l2));
}

class PerViewFit : public testing::TestWithParam<Kernel> {};

TEST_P(PerViewFit, ADiffuseMaterialMeetsTheTolerance) {
  FitOptions options;
  options.kernel = GetParam();
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::lambert), options, progress);
  expect_sound(model);
  EXPECT_EQ(model.fit.warnings, std::vector<Warning>{});
  for (const auto& [view, error] : model.fit.by_view_angle)
    EXPECT_LE(error.value(), view == "85" ? 0.04 : 0.02) << view;
  EXPECT_NEAR(model.fit.albedo_max, 0.5, 0.01);
  EXPECT_EQ(progress.fraction(), 1);
}

TEST_P(PerViewFit, AGlossyMaterialMeetsTheToleranceAwayFromGrazing) {
  FitOptions options;
  options.kernel = GetParam();
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.3f, 0.3f)), options, progress);
  expect_sound(model);
  // The tails of Abel-Poisson are too heavy for GGX: a few percent are its limit.
  const double limit = GetParam() == Kernel::gaussian ? 0.02 : 0.045;
  for (const char* view : {"5", "30", "60"}) EXPECT_LE(model.fit.by_view_angle.at(view).value(), limit) << view;
}

INSTANTIATE_TEST_SUITE_P(Kernels, PerViewFit, testing::Values(Kernel::gaussian, Kernel::abel_poisson));

TEST(PerViewFitRules, TheSameBitsForAnyThreadCount) {
  const AnalyticMeasurement glossy(test::ggx(0.2f, 0.2f));
  FitOptions options;
  options.max_lobes = 4;
  Progress progress;
  options.threads = 1;
  const Model one = fit_per_view(glossy, options, progress);
  options.threads = 4;
  const Model four = fit_per_view(glossy, options, progress);
  EXPECT_EQ(lobes_of(one).center, lobes_of(four).center);
  EXPECT_EQ(lobes_of(one).bandwidth, lobes_of(four).bandwidth);
  EXPECT_EQ(lobes_of(one).coefficient, lobes_of(four).coefficient);
  EXPECT_EQ(one.fit.by_view_angle, four.fit.by_view_angle);
}

TEST(PerViewFitRules, HeldOutViewsAreNotRead) {
  std::atomic<bool> checking{false}, read{false};
  AnalyticMeasurement watched(test::lambert);
  Progress progress;
  watched.set_coverage([&](const DirectionPair& p) {
    if (std::string(progress.stage_name()) == "checking the model") checking = true;
    const double theta = std::acos(std::min(1.0f, p.wv.z)) * 180 / kPiD;
    for (const int degrees : kHeldOutViews) {
      if (!checking && std::abs(theta - degrees) < kHeldOutMargin) read = true;
    }
    return true;
  });
  FitOptions options;
  options.max_lobes = 2;
  fit_per_view(watched, options, progress);
  EXPECT_TRUE(checking);
  EXPECT_FALSE(read);
}

TEST(PerViewFitRules, AllDataReadsThem) {
  FitOptions options;
  options.max_lobes = 1;
  options.all_data = true;
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::lambert), options, progress);
  EXPECT_TRUE(model.fit.all_data);
  bool found = false;
  for (const Vec3& v : lobes_of(model).views) found |= glm::distance(v, direction(radians_from(30.0f), 0)) < 1e-5f;
  EXPECT_TRUE(found);
}

TEST(PerViewFitRules, CancelStopsWithinATenthOfASecond) {
  const AnalyticMeasurement glossy(test::ggx(0.1f, 0.1f));
  for (const int milliseconds : {0, 5, 30, 100}) {
    Progress progress;
    std::chrono::steady_clock::time_point asked;
    std::thread canceller([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      asked = std::chrono::steady_clock::now();
      progress.cancel();
    });
    FitOptions options;
    options.max_lobes = 64;
    options.tolerance = 1e-6;
    EXPECT_THROW(fit_per_view(glossy, options, progress), Error);
    const auto ended = std::chrono::steady_clock::now();
    canceller.join();
    EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 0.1) << milliseconds;
  }
}

TEST(PerViewFitRules, ABlackMaterialIsAModelWithoutLobes) {
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement([](const DirectionPair&) { return Rgb(0); }), {}, progress);
  EXPECT_EQ(lobes_of(model).lobe_count(), 0);
  EXPECT_GT(lobes_of(model).views.size(), 0u);
  EXPECT_EQ(model.fit.relative_l2, 0);
  EXPECT_EQ(model.fit.albedo_max, 0);
}

TEST(PerViewFitRules, NothingValidIsRefused) {
  AnalyticMeasurement nothing(test::lambert);
  nothing.set_coverage([](const DirectionPair&) { return false; });
  Progress progress;
  try {
    fit_per_view(nothing, {}, progress);
    FAIL() << "a measurement without valid entries was fitted";
  } catch (const Error& e) {
    EXPECT_EQ(e.status(), Status::bad_data);
    EXPECT_NE(std::string(e.what()).find("analytic.test' covers less than half of the light directions at every view"),
              std::string::npos);
  }
}

TEST(PerViewFitRules, NotANumberIsLeftOut) {
  const AnalyticMeasurement broken([](const DirectionPair& p) {
    return p.wl.x > 0.9f ? Rgb(std::numeric_limits<float>::quiet_NaN()) : test::lambert(p);
  });
  FitOptions options;
  options.max_lobes = 3;
  Progress progress;
  const auto fit = [&] { return fit_per_view(broken, options, progress); };
  const PerViewBrdf brdf = lobes_of(fit());
  for (const Rgb& c : brdf.coefficient) EXPECT_TRUE(std::isfinite(c.r + c.g + c.b));
}

TEST(PerViewFitRules, UncoveredViewsAreLeftOutAndNamed) {
  AnalyticMeasurement half(test::lambert);
  half.set_coverage([](const DirectionPair& p) { return p.wv.z > std::cos(radians_from(70.0f)); });
  FitOptions options;
  options.max_lobes = 4;
  Progress progress;
  const Model model = fit_per_view(half, options, progress);
  for (const Vec3& v : lobes_of(model).views) EXPECT_GT(v.z, std::cos(radians_from(70.0f)));
  EXPECT_FALSE(model.fit.by_view_angle.at("75").has_value());
  const Warning* told = test::find_warning(model.fit.warnings, WarningCode::views_not_covered);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(test::value_of<std::vector<double>>(*told, "views"), (std::vector<double>{75, 85}));
}

TEST(PerViewFitRules, ViewsThatMissTheToleranceAreNamed) {
  FitOptions options;
  options.max_lobes = 1;
  options.tolerance = 0.001;
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.3f, 0.3f)), options, progress);
  ASSERT_FALSE(model.fit.warnings.empty());
  const Warning& told = model.fit.warnings[0];
  EXPECT_EQ(told.code, WarningCode::views_exceed_tolerance);
  EXPECT_EQ(test::value_of<std::vector<double>>(told, "views"), (std::vector<double>{5, 30, 60, 75, 85}));
  const auto errors = test::value_of<std::vector<double>>(told, "errors");
  EXPECT_EQ(errors.front(), *model.fit.by_view_angle.at("5"));
  EXPECT_GT(errors.back(), 0.002);
  EXPECT_EQ(test::value_of<double>(told, "tolerance"), 0.001);
}

TEST(PerViewFitRules, OfManyViewsThatMissTheToleranceTwelveAreNamed) {
  FitOptions options;
  options.max_lobes = 1;
  options.tolerance = 0.001;
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.3f, 0.3f)), options, progress);
  const Warning* found = test::find_warning(model.fit.warnings, WarningCode::fitted_views_exceed_tolerance);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(test::value_of<std::vector<double>>(*found, "views").size(), 12u);
  EXPECT_TRUE(test::value_of<std::vector<double>>(*found, "azimuths").empty()) << "isotropic";
  EXPECT_GT(test::value_of<uint64_t>(*found, "missed"), 12u);
  EXPECT_LE(test::value_of<uint64_t>(*found, "missed"), test::value_of<uint64_t>(*found, "fitted"));
}

TEST(PerViewFitRules, TheBoundInBytesHolds) {
  const AnalyticMeasurement glossy(test::ggx(0.2f, 0.2f));
  for (const uint64_t bytes : {24u, 500u, 4000u}) {
    FitOptions options;
    options.max_lobes = 5;
    options.max_bytes = bytes;
    Progress progress;
    const Model model = fit_per_view(glossy, options, progress);
    expect_sound(model);
    EXPECT_LE(lobes_of(model).parameter_bytes(), bytes);
    EXPECT_EQ(model.fit.warnings.back().code, WarningCode::model_bounded);
  }
}

TEST(PerViewFitRules, TheBoundIsOfWhateverTheCallerCounts) {
  FitOptions options;
  options.max_lobes = 5;
  options.max_bytes = 2000;
  options.size_of = [](const Model& model) { return lobes_of(model).parameter_bytes() + 1500; };
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.2f, 0.2f)), options, progress);
  EXPECT_LE(options.size_of(model), 2000u);
  EXPECT_GE(options.size_of(model), 1700u) << "most of the bound is used";
}

TEST(PerViewFitRules, TheOrderCurveFallsToTheModel) {
  FitOptions options;
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.3f, 0.3f)), options, progress);
  const OrderCurve& order = model.fit.order;
  ASSERT_GE(order.points.size(), 3u);
  EXPECT_EQ(order.points[0].lobes, 1);
  EXPECT_EQ(order.points[1].lobes, 2);
  for (size_t i = 1; i < order.points.size(); ++i) {
    EXPECT_GT(order.points[i].parameter_bytes, order.points[i - 1].parameter_bytes);
    EXPECT_LE(order.points[i].worst, order.points[i - 1].worst);
    EXPECT_LE(order.points[i].relative_l2, order.points[i - 1].relative_l2);
  }
  ASSERT_EQ(order.chosen, order.points.size() - 1);
  EXPECT_EQ(order.points.back().lobes, lobes_of(model).max_lobes_per_view());
  EXPECT_EQ(order.points.back().parameter_bytes, lobes_of(model).parameter_bytes());
  EXPECT_GT(order.points.front().worst, 1);
  EXPECT_LE(order.points.back().worst, 1);
}

TEST(PerViewFitRules, ABoundedModelStandsOnTheCurveOfTheWholeOne) {
  FitOptions options;
  Progress progress;
  const AnalyticMeasurement glossy(test::ggx(0.3f, 0.3f));
  const Model whole = fit_per_view(glossy, options, progress);
  options.max_bytes = lobes_of(whole).parameter_bytes() / 2;
  const Model bounded = fit_per_view(glossy, options, progress);
  const OrderCurve& order = bounded.fit.order;
  EXPECT_EQ(order.points.back(), whole.fit.order.points.back());
  ASSERT_TRUE(order.chosen);
  EXPECT_EQ(order.points[*order.chosen].parameter_bytes, lobes_of(bounded).parameter_bytes());
  EXPECT_LT(*order.chosen, order.points.size() - 1);
}

TEST(PerViewFitRules, AnisotropicMaterialsHaveViewsOverTheHemisphere) {
  FitOptions options;
  options.max_lobes = 3;
  options.tolerance = 0.2;
  Progress progress;
  const Model model = fit_per_view(AnalyticMeasurement(test::ggx(0.5f, 0.25f), false), options, progress);
  expect_sound(model);
  EXPECT_FALSE(lobes_of(model).isotropic);
  EXPECT_LE(model.fit.by_view_angle.at("30").value(), 0.25);
}

TEST(PerViewFitRules, OptionsOutOfRangeAreRefused) {
  const AnalyticMeasurement diffuse(test::lambert);
  const auto status_of = [&](auto change) {
    FitOptions options;
    change(options);
    Progress progress;
    try {
      fit_per_view(diffuse, options, progress);
    } catch (const Error& e) {
      return e.status();
    }
    return Status::ok;
  };
  EXPECT_EQ(status_of([](FitOptions& o) { o.tolerance = 0; }), Status::invalid_argument);
  EXPECT_EQ(status_of([](FitOptions& o) { o.tolerance = std::nan(""); }), Status::invalid_argument);
  EXPECT_EQ(status_of([](FitOptions& o) { o.max_lobes = 0; }), Status::invalid_argument);
  EXPECT_EQ(status_of([](FitOptions& o) { o.max_lobes = LobeMixture::kCapacity / 2 + 1; }), Status::invalid_argument);
  EXPECT_EQ(status_of([](FitOptions& o) { o.threads = -1; }), Status::invalid_argument);
  EXPECT_EQ(status_of([](FitOptions& o) { o.max_bytes = 23; }), Status::invalid_argument);
}

}  // namespace
}  // namespace velour::per_view_fit_test
