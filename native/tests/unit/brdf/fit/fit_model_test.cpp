#include "brdf/fit/fit_model.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/analytic_measurement.h"

namespace velour {
namespace {

using test::AnalyticMeasurement;

const AnalyticMeasurement& glossy() {
  static const AnalyticMeasurement measurement(test::ggx(0.3f, 0.3f));
  return measurement;
}

TEST(FitModel, TheKindIsWhatWasAskedFor) {
  FitOptions options;
  options.max_lobes = 2;
  Progress progress;
  EXPECT_EQ(std::string(model_kind(fit_model(ModelKind::per_view, glossy(), options, progress))), "scattered");
  EXPECT_EQ(std::string(model_kind(fit_model(ModelKind::parametric, glossy(), options, progress))), "parametric");
}

TEST(FitModel, TheBoundInBytesHoldsForParametricModels) {
  FitOptions options;
  options.max_lobes = 4;
  options.tolerance = 1e-4;
  options.max_bytes = 300;  // two lobes of 133
  Progress progress;
  const Model model = fit_model(ModelKind::parametric, glossy(), options, progress);
  EXPECT_LE(std::get<ParametricBrdf>(model.body).parameter_bytes(), options.max_bytes);
  EXPECT_EQ(std::get<ParametricBrdf>(model.body).lobe_count(), 2);
  options.max_bytes = 100;
  EXPECT_THROW(fit_model(ModelKind::parametric, glossy(), options, progress), Error);
}

}  // namespace
}  // namespace velour
