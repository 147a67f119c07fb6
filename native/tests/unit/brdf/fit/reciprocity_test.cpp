#include "brdf/fit/fit_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/eval/per_view_material.h"
#include "math/sphere/frame.h"
#include "support/analytic_measurement.h"
#include "support/materials.h"

namespace velour::reciprocity_test {
namespace {

using test::AnalyticMeasurement;

double error_of(const AnalyticMeasurement& measurement) { return reciprocity_error(measurement, Progress()).value(); }

TEST(Reciprocity, HoldsForReciprocalFormulas) {
  EXPECT_LT(error_of(AnalyticMeasurement(test::lambert)), 1e-6);
  EXPECT_LT(error_of(AnalyticMeasurement(test::ggx(0.1f, 0.1f))), 1e-4);
  EXPECT_LT(error_of(AnalyticMeasurement(test::ggx(0.5f, 0.2f), false)), 1e-4);
}

TEST(Reciprocity, OfACosineTooManyIsWhatTheIntegralGives) {
  // With m and n the two cosines, a = m^2 n and b = m n^2; the mean of m^k over the hemisphere is 1 / (k + 1).
  const double expected = std::sqrt(2 * (1.0 / 15 - 1.0 / 16) / (1.0 / 15));
  const AnalyticMeasurement skewed([](const DirectionPair& p) { return Rgb(p.wl.z); });
  EXPECT_NEAR(error_of(skewed), expected, 0.01 * expected);
}

TEST(Reciprocity, OfPairsWithOneBlackMemberIsTheRootOfTwo) {
  const AnalyticMeasurement one_way([](const DirectionPair& p) { return Rgb(p.wl.z > p.wv.z ? 1.0f : 0.0f); });
  EXPECT_NEAR(error_of(one_way), std::sqrt(2.0), 1e-3);
}

TEST(Reciprocity, UncoveredPairsDoNotCount) {
  AnalyticMeasurement part([](const DirectionPair& p) { return Rgb(p.wl.z > 0.5f ? 1.0f : 2.0f); });
  part.set_coverage([](const DirectionPair& p) { return p.wl.z > 0.5f; });
  EXPECT_EQ(error_of(part), 0);
  part.set_coverage([](const DirectionPair&) { return false; });
  EXPECT_EQ(reciprocity_error(part, Progress()), std::nullopt);
}

TEST(Reciprocity, OfAModelIsThatOfItsValues) {
  PerViewBrdf diffuse;
  diffuse.views = {{0, 0, 1}};
  diffuse.first_lobe = {0, 0};
  diffuse.diffuse = {Rgb(0.2f)};
  const auto error = [](const PerViewBrdf& brdf) {
    return reciprocity_error(*make_per_view_material(std::make_shared<const PerViewBrdf>(brdf), 0), Progress());
  };
  EXPECT_LT(error(diffuse), 1e-6);
  EXPECT_GT(error(test::isotropic_model()), 0.05) << "its lobes do not depend on the view as reciprocity asks";
}

}  // namespace
}  // namespace velour::reciprocity_test
