#include "plot/model_plots.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "plot/plot.h"

namespace velour::fit_plots_test {
namespace {

Model fitted_model() {
  Model model;
  model.fit.tolerance = 0.02;
  model.fit.by_view_angle = {{"5", 0.01}, {"30", 0.012}, {"60", 0.018}, {"75", 0.03}, {"85", std::nullopt}};
  model.fit.order.points = {{1, 52, 20, 0.3}, {2, 80, 8, 0.1}, {4, 136, 0.9, 0.01}, {8, 248, 0.7, 0.008}};
  model.fit.order.chosen = 2;
  return model;
}

TEST(OrderPlot, HasThePointsOfTheFitAndTheOneThatWasChosen) {
  const Plot plot = order_plot(fitted_model());
  ASSERT_EQ(plot.series.size(), 2u);
  const PlotSeries& tolerance = plot.series[0];
  const PlotSeries& error = plot.series[1];
  ASSERT_EQ(error.points.size(), 4u);
  EXPECT_EQ(error.points[2].x, 4);
  EXPECT_EQ(error.points[2].y, 0.9);
  EXPECT_EQ(error.chosen, 2u);
  for (const PlotPoint& p : tolerance.points) EXPECT_EQ(p.y, 1);
  EXPECT_LE(plot.y.low, 0.7);
  EXPECT_GE(plot.y.high, 20);
}

TEST(OrderPlot, OfABtfIsErrorAgainstBytes) {
  Model model;
  model.btf.emplace();
  model.btf->tolerance = 0.2;
  model.btf->order.points = {{4, 20000, 2, 0.4}, {16, 80000, 0.9, 0.18}};
  const Plot plot = order_plot(model);
  EXPECT_EQ(plot.x.column, "parameter_bytes");
  EXPECT_EQ(plot.series.back().points[1].x, 80000);
  EXPECT_EQ(plot.series.back().points[1].y, 0.18);
  EXPECT_EQ(plot.series.front().points[0].y, 0.2) << "the tolerance";
}

TEST(OrderPlot, OfABlackMaterialIsDrawn) {
  Model model = fitted_model();
  for (OrderPoint& p : model.fit.order.points) p.worst = 0;
  const Plot plot = order_plot(model);
  EXPECT_GT(plot.y.low, 0);
  EXPECT_GT(plot.y.high, plot.y.low);
}

TEST(ViewErrorPlot, LeavesOutWhatWasNotMeasured) {
  const Plot plot = view_error_plot(fitted_model().fit);
  const PlotSeries& error = plot.series.back();
  ASSERT_EQ(error.points.size(), 4u);
  EXPECT_EQ(error.points[3].x, 75);
  EXPECT_EQ(error.points[3].y, 0.03);
  EXPECT_EQ(plot.series.front().points.front().y, 0.02);
  EXPECT_EQ(plot.series.front().points.back().y, 0.04) << "twice the tolerance beyond 75 degrees";
}

TEST(FitPlots, SayWhenThereIsNothing) {
  EXPECT_THROW(order_plot(Model{}), Error);
  EXPECT_THROW(view_error_plot(FitRecord{}), Error);
}

TEST(PlotCsv, HasEveryNumberWithAllItsDigits) {
  EXPECT_EQ(csv_text(view_error_plot(fitted_model().fit)),
            "series,theta_v_degrees,relative_l2,chosen\n"
            "tolerance,0,0.02,0\ntolerance,75,0.02,0\ntolerance,75,0.04,0\ntolerance,90,0.04,0\n"
            "error,5,0.01,0\nerror,30,0.012,0\nerror,60,0.018,0\nerror,75,0.03,0\n");
  const std::string order = csv_text(order_plot(fitted_model()));
  EXPECT_NE(order.find("error,4,0.9,1\n"), std::string::npos) << order;
}

}  // namespace
}  // namespace velour::fit_plots_test
