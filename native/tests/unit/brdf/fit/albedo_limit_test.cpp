#include "brdf/fit/error/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "brdf/eval/parametric_material.h"
#include "brdf/fit/parametric/parametric_fit.h"
#include "support/analytic_measurement.h"
#include "support/hostile_measurements.h"
#include "support/parametric_models.h"
#include "support/warnings.h"

namespace velour::albedo_limit_test {
namespace {

double largest_albedo(const ParametricBrdf& brdf) {
  const auto material = make_parametric_material(std::make_shared<const ParametricBrdf>(brdf));
  double most = 0;
  for (float degrees = 0.25f; degrees < 90; degrees += 0.7f) {  // not the views that the limit looks at
    for (const float azimuth : {0.0f, 1.0f, 2.0f, 4.0f}) {
      const Vec3d a = directional_albedo(*material, direction(radians_from(degrees), azimuth));
      most = std::max({most, a.x, a.y, a.z});
    }
  }
  return most;
}

/// The example of half the light at the normal, brighter, and much brighter towards the horizon.
ParametricBrdf bright(bool isotropic, float factor) {
  auto recipe = test::highlight_recipe(30);
  for (auto& lobe : recipe) lobe.coefficient *= factor;
  return test::parametric_model(isotropic, recipe);
}

TEST(AlbedoLimit, NoViewReflectsMoreThanArrives) {
  Progress progress;
  for (const bool isotropic : {true, false}) {
    ParametricBrdf brdf = bright(isotropic, 2.2f);
    EXPECT_GT(largest_albedo(brdf), 1.2);
    EXPECT_TRUE(limit_albedo(brdf, 0, progress));
    const double limited = largest_albedo(brdf);
    EXPECT_LE(limited, 1);
    EXPECT_GT(limited, 0.99);  // and no further
  }
}

TEST(AlbedoLimit, LeavesOtherViewsAlone) {
  Progress progress;
  auto recipe = test::highlight_recipe(30);
  recipe[0].rise = 3;  // half the light at the normal, all of it and more at the horizon
  const ParametricBrdf before = test::parametric_model(true, recipe);
  ParametricBrdf after = before;
  ASSERT_TRUE(limit_albedo(after, 0, progress));
  EXPECT_EQ(after.control[after.index(0, ParametricBrdf::kLogRed, 0)],
            before.control[before.index(0, ParametricBrdf::kLogRed, 0)]);
}

TEST(AlbedoLimit, ChangesNothingBelowOne) {
  Progress progress;
  ParametricBrdf brdf = bright(true, 0.3f);
  const std::vector<float> before = brdf.control;
  EXPECT_FALSE(limit_albedo(brdf, 0, progress));
  EXPECT_EQ(brdf.control, before);
}

TEST(AlbedoLimit, IsAnOptionOfTheFit) {
  const auto half = test::ggx(0.3f, 0.3f);
  const test::AnalyticMeasurement metal([half](const DirectionPair& p) { return 1.4f * half(p); });
  Progress progress;
  FitOptions options;
  const Model free = fit_parametric(metal, options, progress);
  EXPECT_GT(free.fit.albedo_max, 1.05);
  options.limit_albedo = true;
  const Model limited = fit_parametric(metal, options, progress);
  EXPECT_LE(limited.fit.albedo_max, 1);
  EXPECT_GT(limited.fit.relative_l2, 2 * free.fit.relative_l2);  // and the errors are those of what was written
}

TEST(AlbedoLimit, DoesNotHideAWrongScale) {
  const test::AnalyticMeasurement metal(test::scaled(test::ggx(0.3f, 0.3f), 1500));
  Progress progress;
  FitOptions options;
  options.max_lobes = 2;
  options.limit_albedo = true;
  const Model model = fit_parametric(metal, options, progress);
  const Warning* told = test::find_warning(model.fit.warnings, WarningCode::implausible_albedo);
  ASSERT_NE(told, nullptr);
  EXPECT_GT(test::value_of<double>(*told, "albedo"), 1000);  // of the measurement; that of the model is 1 at most
}

TEST(AlbedoLimit, HoldsForSymmetricModelsToo) {
  Progress progress;
  ParametricBrdf brdf = bright(true, 2.2f);
  brdf.symmetric = true;
  ASSERT_GT(largest_albedo(brdf), 1.05);
  EXPECT_TRUE(limit_albedo(brdf, 0, progress));
  EXPECT_LE(largest_albedo(brdf), 1);
}

}  // namespace
}  // namespace velour::albedo_limit_test
