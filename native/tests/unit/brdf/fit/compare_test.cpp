#include "brdf/fit/error/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/measure/held_out.h"
#include "support/hostile_measurements.h"

namespace velour::compare_test {
namespace {

using test::AnalyticMeasurement;

/// A material that is a formula; only eval matters to compare().
class FormulaMaterial : public Material {
 public:
  explicit FormulaMaterial(AnalyticMeasurement::Formula f) : f_(std::move(f)) {}
  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& /*site*/, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<Prepared>(f_, wv);
  }
  bool isotropic() const override { return true; }

 private:
  class Prepared final : public PreparedBrdf {
   public:
    Prepared(const AnalyticMeasurement::Formula& f, const Vec3& wv) : f_(f), wv_(wv) {}
    void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
      for (int i = 0; i < wl.count; ++i) f.set(i, f_({wl.get(i), wv_})), pdf.v[i] = 0;
    }
    void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
      wl.fill(u, [](const Vec2&) { return Vec3(0, 0, 1); });
    }

   private:
    const AnalyticMeasurement::Formula& f_;
    Vec3 wv_;
  };

  AnalyticMeasurement::Formula f_;
};

/// A scattered measurement whose samples are given.
class Samples : public AnalyticMeasurement {
 public:
  explicit Samples(std::vector<IrregularSample> samples)
      : AnalyticMeasurement(test::lambert), samples_(std::move(samples)) {}
  std::span<const IrregularSample> samples() const override { return samples_; }

 private:
  std::vector<IrregularSample> samples_;
};

AnalyticMeasurement::Formula scaled(float by) {
  return [by](const DirectionPair& p) { return by * test::lambert(p); };
}

TEST(Compare, AModelThatIsTheMeasurementHasNoError) {
  Progress progress;
  const Comparison c = compare(AnalyticMeasurement(test::lambert), FormulaMaterial(test::lambert), progress);
  EXPECT_EQ(c.relative_l2, 0);
  EXPECT_EQ(c.log_rms, 0);
  EXPECT_GT(c.samples, 5u * 4000u);
  EXPECT_EQ(c.standard_error, 0);
  for (const auto& [view, error] : c.by_view_angle) EXPECT_EQ(error, 0.0) << view;
  for (const auto& [view, noise] : c.noise_by_view_angle) EXPECT_NEAR(noise.value_or(1), 0, 1e-6) << view;
}

TEST(Compare, AModelTenPercentTooBrightIsTenPercentOff) {
  Progress progress;
  const Comparison c = compare(AnalyticMeasurement(test::lambert), FormulaMaterial(scaled(1.1f)), progress);
  EXPECT_NEAR(c.relative_l2, 0.1, 1e-5);
  EXPECT_EQ(c.by_view_angle.size(), kHeldOutViews.size());
  EXPECT_GT(c.log_rms, 0.05);
}

/// The model's error grows towards grazing views.
TEST(Compare, TheMeanWeighsViewsByTheirCosines) {
  Progress progress;
  const auto off = [](const DirectionPair& p) { return (2 - p.wv.z) * test::lambert(p); };
  const Comparison c = compare(AnalyticMeasurement(test::lambert), FormulaMaterial(off), progress);
  double sum = 0, weights = 0;
  for (const auto& [view, error] : c.by_view_angle) {
    const double weight = std::cos(radians_from(std::stod(view)));
    EXPECT_NEAR(error.value(), 1 - weight, 1e-3) << view;
    sum += weight * *error;
    weights += weight;
  }
  EXPECT_NEAR(c.relative_l2, sum / weights, 1e-9);
}

TEST(Compare, UncoveredViewsAreNullAndDoNotCount) {
  AnalyticMeasurement half(test::lambert);
  half.set_coverage([](const DirectionPair& p) { return p.wv.z > std::cos(radians_from(70.0f)); });
  Progress progress;
  const Comparison c = compare(half, FormulaMaterial(scaled(1.1f)), progress);
  EXPECT_TRUE(c.by_view_angle.at("60").has_value());
  EXPECT_FALSE(c.by_view_angle.at("75").has_value());
  EXPECT_FALSE(c.noise_by_view_angle.at("75").has_value());
  EXPECT_FALSE(c.standard_error_by_view_angle.at("75").has_value());
}

TEST(Compare, UncoveredLightsAreLeftOutNotTakenForBlack) {
  AnalyticMeasurement part(test::lambert);
  part.set_coverage([](const DirectionPair& p) { return p.wl.x > 0; });
  Progress progress;
  EXPECT_EQ(compare(part, FormulaMaterial(test::lambert), progress).relative_l2, 0);
}

TEST(Compare, ANarrowHighlightIsSeen) {
  const AnalyticMeasurement mirror(test::near_mirror(1e6));
  Progress progress;
  const Comparison without_it = compare(mirror, FormulaMaterial(scaled(0.02f)), progress);
  EXPECT_GT(without_it.relative_l2, 0.99);
  EXPECT_LT(compare(mirror, FormulaMaterial(test::near_mirror(1e6)), progress).relative_l2, 1e-6);
}

TEST(Compare, AHandfulOfDirectionsIsNoView) {
  AnalyticMeasurement part(test::lambert);
  part.set_coverage([](const DirectionPair& p) { return p.wl.z > 0.99f; });
  Progress progress;
  const Comparison c = compare(part, FormulaMaterial(test::lambert), progress);
  EXPECT_NEAR(c.covered_share.at(30), 0.01, 0.003);
  EXPECT_EQ(c.by_view_angle.at("30"), std::nullopt);
  EXPECT_EQ(c.relative_l2, 1) << "nothing good is claimed of what is not known";
}

TEST(Compare, BlackIsExactOrWrong) {
  const auto black = [](const DirectionPair&) { return Rgb(0); };
  Progress progress;
  EXPECT_EQ(compare(AnalyticMeasurement(black), FormulaMaterial(black), progress).relative_l2, 0);
  EXPECT_EQ(compare(AnalyticMeasurement(black), FormulaMaterial(test::lambert), progress).relative_l2, 1);
}

TEST(Compare, NoiseOfASkewedMeasurementIsSeen) {
  // 10 % more on one side of the plane of incidence: paired values 1.1 and 0.9 lie 0.2 apart.
  const auto skewed = [](const DirectionPair& p) { return test::lambert(p) * (p.wl.y > 0 ? 1.1f : 0.9f); };
  Progress progress;
  const Comparison c = compare(AnalyticMeasurement(skewed), FormulaMaterial(test::lambert), progress);
  const double expected = 0.2 / std::sqrt(2.0) / std::sqrt(0.5 * (1.1 * 1.1 + 0.9 * 0.9));
  EXPECT_NEAR(c.noise_by_view_angle.at("30").value(), expected, 0.01);
}

TEST(Compare, IrregularSamplesCountOnlyWhenHeldOut) {
  std::vector<IrregularSample> samples;
  const Vec3 wv = direction(radians_from(32.0f), 0);
  for (uint64_t i = 0; i < 800; ++i) {
    // The others are wrong on purpose: they must not be looked at.
    const float value = held_out_sample(i) ? 1.0f : 100.0f;
    samples.push_back(
        {direction(0.01f * static_cast<float>(i % 100), static_cast<float>(i)), wv, value * test::lambert({})});
  }
  Progress progress;
  const Comparison c = compare(Samples(samples), FormulaMaterial(scaled(0.9f)), progress);
  EXPECT_NEAR(c.by_view_angle.at("30").value(), 0.1, 1e-5);
  EXPECT_FALSE(c.by_view_angle.at("5").has_value());
  EXPECT_NEAR(c.relative_l2, 0.1, 1e-5);
  EXPECT_LT(c.samples, 150u);
}

TEST(Compare, CancelStopsIt) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(compare(AnalyticMeasurement(test::lambert), FormulaMaterial(test::lambert), progress), Error);
}

TEST(ViewError, IsTheWeightedRatioOfNorms) {
  ViewError e;
  e.add(2, Rgb(1), Rgb(1.5f), 1);
  e.add(1, Rgb(2), Rgb(2), 0.5);
  EXPECT_NEAR(e.relative_l2(), std::sqrt(2 * 0.25 / (2 + 1)), 1e-6);
}

/// A highlight of the wrong width: the error lies in a few directions, and its standard error says how well they know
/// it.
TEST(Compare, TheErrorIsKnownToFivePercentOfItself) {
  Progress progress;
  const Comparison c =
      compare(AnalyticMeasurement(test::near_mirror(1e5)), FormulaMaterial(test::near_mirror(8e4)), progress);
  for (const auto& [view, error] : c.by_view_angle) {
    EXPECT_GT(error.value(), 0.05) << view;
    EXPECT_GT(c.standard_error_by_view_angle.at(view).value(), 0) << view;
    EXPECT_LE(c.standard_error_by_view_angle.at(view).value(), 0.05 * *error) << view;
  }
  EXPECT_LT(c.standard_error, 0.05 * c.relative_l2);
}

}  // namespace
}  // namespace velour::compare_test
