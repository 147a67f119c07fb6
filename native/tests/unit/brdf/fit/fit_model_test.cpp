#include "brdf/fit/fit_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/analytic_measurement.h"

namespace velour::fit_model_test {
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

TEST(FitModel, TheAutomaticChoiceIsParametricAsLongAsItIsGoodEnough) {
  const FitOptions options;
  Progress progress;
  const Model good = fit_model(ModelKind::automatic, glossy(), options, progress);
  EXPECT_EQ(std::get<ParametricBrdf>(good.body).cells, 10);
  EXPECT_EQ(good.fit.by_view_angle, fit_model(ModelKind::parametric, glossy(), options, progress).fit.by_view_angle);
}

TEST(FitModel, TheAutomaticChoiceIsLargerWhereParametricFails) {
  // A highlight that brightens and dims every ten degrees of the view, faster than splines of ten cells.
  const AnalyticMeasurement swinging([](const DirectionPair& p) {
    const float theta = std::acos(std::min(p.wv.z, 1.0f)) * 180 / kPi;
    const Vec3 h = glm::normalize(p.wl + p.wv);
    return Rgb(0.1f / kPi + (1 + 0.9f * std::sin(2 * kPi * theta / 10)) * std::exp(80 * (h.z - 1)));
  });
  const FitOptions options;
  Progress progress;
  const double parametric = fit_model(ModelKind::parametric, swinging, options, progress).fit.relative_l2;
  const Model chosen = fit_model(ModelKind::automatic, swinging, options, progress);
  const auto* finer = std::get_if<ParametricBrdf>(&chosen.body);
  EXPECT_TRUE(!finer || finer->cells == 20);
  EXPECT_LT(1.3 * chosen.fit.relative_l2, parametric);
}

/// Samples between which the measurement interpolates far too brightly. Parametric models read the samples, per-view
/// models the interpolation.
class BadlyInterpolated final : public AnalyticMeasurement {
 public:
  explicit BadlyInterpolated(std::vector<IrregularSample> samples)
      : AnalyticMeasurement([f = test::ggx(0.3f, 0.3f)](const DirectionPair& p) { return 3.0f * f(p); }),
        samples_(std::move(samples)) {}
  std::span<const IrregularSample> samples() const override { return samples_; }
  std::shared_ptr<const Measurement> without_held_out(const Progress& /*progress*/) const override {
    std::vector<IrregularSample> kept;
    for (size_t i = 0; i < samples_.size(); ++i) {
      if (!held_out_sample(i)) kept.push_back(samples_[i]);
    }
    return std::make_shared<BadlyInterpolated>(kept);
  }

 private:
  std::vector<IrregularSample> samples_;
};

std::vector<IrregularSample> glossy_samples(uint64_t count) {
  const auto f = test::ggx(0.3f, 0.3f);
  std::vector<IrregularSample> samples;
  for (uint64_t i = 0; i < count; ++i) {
    RandomStream random(5, i, 0);
    const Vec3 wl = sample_cosine_hemisphere(random.next2()), wv = sample_cosine_hemisphere(random.next2());
    samples.push_back({wl, wv, f({wl, wv})});
  }
  return samples;
}

/// Retro-reflective materials given as samples got models that look nothing like them, whose errors were smaller.
TEST(FitModel, PicturesOutweighErrorsOfIrregularSamples) {
  FitOptions options;
  options.tolerance = 0.3;  // few lobes
  Progress progress;
  const BadlyInterpolated measurement(glossy_samples(400));
  const double parametric = fit_model(ModelKind::parametric, measurement, options, progress).fit.relative_l2;
  options.verdict_on = [](const Model& model, Progress&) {
    const bool is_good = std::string(model_kind(model)) == "scattered";
    return std::optional(is_good ? Verdict{LookQuality::good, 0.01, 0.02} : Verdict{LookQuality::poor, 0.2, 0.4});
  };
  const Model chosen = fit_model(ModelKind::automatic, measurement, options, progress);
  EXPECT_EQ(std::string(model_kind(chosen)), "scattered");
  EXPECT_GT(chosen.fit.relative_l2, 2 * parametric);
}

TEST(FitModel, OptionsOfOneKindDecide) {
  FitOptions options;
  options.max_lobes = 2;
  options.kernel = Kernel::abel_poisson;
  Progress progress;
  EXPECT_EQ(std::string(model_kind(fit_model(ModelKind::automatic, glossy(), options, progress))), "scattered");
  options = {};
  options.max_lobes = 1;
  EXPECT_EQ(std::get<ParametricBrdf>(fit_model(ModelKind::automatic, glossy(), options, progress).body).lobe_count(),
            1);
  options = {};
  options.max_bytes = 300;
  EXPECT_EQ(std::string(model_kind(fit_model(ModelKind::automatic, glossy(), options, progress))), "parametric");
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
}  // namespace velour::fit_model_test
