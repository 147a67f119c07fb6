#include "plot/model_plots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "base/error.h"
#include "brdf/fit/error/evaluate.h"
#include "model/model.h"
#include "support/analytic_measurement.h"
#include "support/example_srbf.h"
#include "support/materials.h"
#include "support/parametric_models.h"

namespace velour::model_plots_test {
namespace {

using namespace velour::test;

std::shared_ptr<const Model> model_of(ModelBody body) {
  auto model = std::make_shared<Model>();
  model->body = std::move(body);
  return model;
}

ParametricBrdf symmetric_model() {
  ParametricBrdf brdf = parametric_model(true, highlight_recipe(200));
  brdf.symmetric = true;
  return brdf;
}

PlotView view_of(double theta, double phi = 0) { return {radians_from(theta), radians_from(phi)}; }

Plot plotted(PlotKind kind, const std::shared_ptr<const Model>& model, const Measurement* measurement,
             const PlotView& view) {
  Progress unwatched;
  return make_plot(kind, model, measurement, view, unwatched);
}

const PlotSeries& series_of(const Plot& plot, std::string_view name) {
  for (const PlotSeries& series : plot.series) {
    if (series.name == name) return series;
  }
  throw std::out_of_range(std::string(name));
}

class LobesPlot : public testing::TestWithParam<std::shared_ptr<const Model>> {};

TEST_P(LobesPlot, LobesAddUpToTheModel) {
  for (const PlotView& view : {view_of(0), view_of(30, 40), view_of(75, -120)}) {
    const Plot plot = plotted(PlotKind::lobes, GetParam(), nullptr, view);
    const PlotSeries& model = series_of(plot, "model");
    double largest = 0;
    for (const PlotPoint& p : model.points) largest = std::max(largest, p.y);
    for (size_t i = 0; i < model.points.size(); ++i) {
      double sum = 0;
      for (const PlotSeries& series : plot.series) {
        if (series.role == PlotRole::lobe) sum += series.points.at(i).y;
      }
      ASSERT_NEAR(sum, model.points[i].y, 2e-4 * largest) << view.theta << " at " << model.points[i].x;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, LobesPlot,
                         testing::Values(model_of(parametric_model(true, highlight_recipe(200))),
                                         model_of(parametric_model(false, highlight_recipe(50))),
                                         model_of(symmetric_model()), model_of(isotropic_model()),
                                         model_of(anisotropic_model())));

TEST(LobesPlot, TheHighlightLiesOppositeToTheViewer) {
  const auto model = model_of(parametric_model(true, {{LobeSpace::half, 1000, Rgb(5)}}));
  const Plot plot = plotted(PlotKind::lobes, model, nullptr, view_of(40));
  const auto& points = series_of(plot, "model").points;
  const auto peak = std::ranges::max_element(points, {}, &PlotPoint::y);
  EXPECT_NEAR(peak->x, 40, 1.0);
  EXPECT_EQ(series_of(plot, "view").points.front().x, -40);
  EXPECT_TRUE(plot.y.logarithmic);
}

TEST(LobesPlot, AFlatMaterialHasALinearRadius) {
  const auto model = model_of(parametric_model(true, {{LobeSpace::light, 1e-4f, Rgb(0.3f)}}));
  const Plot plot = plotted(PlotKind::lobes, model, nullptr, view_of(40));
  EXPECT_FALSE(plot.y.logarithmic);
  EXPECT_EQ(plot.y.low, 0);
}

TEST(LobesPlot, PointsAreThoseOfTheMeasurement) {
  const AnalyticMeasurement measurement(ggx(0.2f, 0.2f));
  const auto model = model_of(isotropic_model());
  const Plot plot = plotted(PlotKind::lobes, model, &measurement, view_of(30));
  const auto& points = series_of(plot, "measured").points;
  EXPECT_GT(points.size(), 80u);
  for (const PlotPoint& p : points) {
    const auto theta = static_cast<float>(radians_from(std::abs(p.x)));
    const Vec3 wl = direction(theta, p.x > 0 ? kPi : 0);
    const Rgb f = ggx(0.2f, 0.2f)({wl, direction(radians_from(30.0f), 0)});
    ASSERT_NEAR(p.y, luminance(f) * wl.z, 2e-5 * std::max(1.0, p.y)) << p.x;
  }
}

TEST(LobesPlot, WhatIsNotCoveredHasNoPoint) {
  AnalyticMeasurement measurement(lambert);
  measurement.set_coverage([](const DirectionPair& p) { return p.wl.x > 0; });
  const Plot plot = plotted(PlotKind::lobes, model_of(isotropic_model()), &measurement, view_of(30));
  for (const PlotPoint& p : series_of(plot, "measured").points) EXPECT_LT(p.x, 0) << "+x is the viewer's side";
}

/// Samples of a Lambertian surface: some in the plane of incidence of 30 degrees, some not.
class FewSamples final : public AnalyticMeasurement {
 public:
  FewSamples() : AnalyticMeasurement(lambert) {
    const Vec3 wv = direction(radians_from(31.0f), 1.0f);
    add(direction(radians_from(50.0f), 1.0f + kPi), wv);                                    // mirror side
    add(direction(radians_from(20.0f), 1.0f), wv);                                          // viewer's side
    add(direction(radians_from(50.0f), 1.0f + 2.0f), wv);                                   // off the plane
    add(direction(radians_from(50.0f), 1.0f + kPi), direction(radians_from(40.0f), 1.0f));  // off the view
  }
  std::span<const IrregularSample> samples() const override { return samples_; }

 private:
  void add(const Vec3& wl, const Vec3& wv) { samples_.push_back({wl, wv, lambert({wl, wv})}); }
  std::vector<IrregularSample> samples_;
};

TEST(LobesPlot, OfIrregularSamplesShowsThoseNearViewAndPlane) {
  const FewSamples measurement;
  const Plot plot = plotted(PlotKind::lobes, model_of(isotropic_model()), &measurement, view_of(30));
  const auto& points = series_of(plot, "measured").points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].x, -20, 0.01);
  EXPECT_NEAR(points[1].x, 50, 0.01);
  EXPECT_NEAR(points[1].y, luminance(Rgb(0.5f, 0.4f, 0.3f)) / kPiD * std::cos(radians_from(50.0)), 1e-5);
}

TEST(AlbedoPlot, OfALambertianSurfaceIsItsColor) {
  // f = 0.25 / pi, as nearly constant as a lobe can be.
  const auto model = model_of(parametric_model(true, {{LobeSpace::light, 1e-4f, Rgb(0.25f, 0.5f, 0.75f) / kPi}}));
  const AnalyticMeasurement measurement(lambert);
  const Plot plot = plotted(PlotKind::albedo, model, &measurement, {});
  EXPECT_EQ(series_of(plot, "model red").points.size(), 90u);
  for (const auto& [name, albedo] : {std::pair("model red", 0.25), std::pair("model blue", 0.75),
                                     std::pair("measured red", 0.5), std::pair("measured blue", 0.3)}) {
    for (const PlotPoint& p : series_of(plot, name).points) ASSERT_NEAR(p.y, albedo, 0.01) << name << " " << p.x;
  }
}

TEST(AlbedoPlot, HasNoMeasuredPointWhereLightsAreMissing) {
  AnalyticMeasurement measurement(lambert);
  measurement.set_coverage([](const DirectionPair& p) { return p.wl.x > -0.3f || p.wv.z > 0.9f; });
  const Plot plot = plotted(PlotKind::albedo, model_of(isotropic_model()), &measurement, {});
  const auto& points = series_of(plot, "measured green").points;
  ASSERT_EQ(points.size(), 6u) << "0 to 25 degrees";
  EXPECT_EQ(points.back().x, 25);
}

TEST(ModelPlots, OfABtfThereIsOnlyTheOrder) {
  auto model = std::make_shared<Model>();
  model->body = example_srbf();
  model->btf.emplace();
  for (const PlotKind kind : {PlotKind::lobes, PlotKind::view_error, PlotKind::albedo}) {
    try {
      plotted(kind, model, nullptr, {});
      FAIL() << "no refusal";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::unsupported);
      EXPECT_NE(std::string(error.what()).find("BTF"), std::string::npos);
    }
  }
}

TEST(AlbedoPlot, TellsHowFarItIsAndCanBeCancelled) {
  const AnalyticMeasurement measurement(lambert);
  Progress progress;
  make_plot(PlotKind::albedo, model_of(isotropic_model()), &measurement, {}, progress);
  EXPECT_DOUBLE_EQ(progress.fraction(), 1.0);
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(make_plot(PlotKind::albedo, model_of(isotropic_model()), nullptr, {}, cancelled), Error);
}

TEST(ModelPlots, AViewBelowTheHorizonIsRefused) {
  EXPECT_THROW(plotted(PlotKind::lobes, model_of(isotropic_model()), nullptr, view_of(90)), Error);
}

}  // namespace
}  // namespace velour::model_plots_test
