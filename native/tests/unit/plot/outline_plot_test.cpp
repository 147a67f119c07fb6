#include "plot/model_plots.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "support/example_shell.h"

namespace velour::outline_plot_test {
namespace {

Model with_shell(std::shared_ptr<VotfVolume> volume) {
  Model model;
  model.shell = ModelShell{std::move(volume), "example"};
  return model;
}

Plot plotted(const Model& model) {
  Progress unwatched;
  return outline_plot(model, unwatched);
}

/// Width of wires along y as a view sees it, as a share of the period.
double covered_by_wires(double radius, double theta, double phi) {
  return std::min(1.0, 2 * radius * std::hypot(1.0, std::tan(theta) * std::cos(phi)));
}

TEST(OutlinePlot, OfWiresIsTheirClosedForm) {
  constexpr double kRadius = 0.2;
  const Plot plot = plotted(with_shell(test::wires(128, static_cast<float>(kRadius))));
  ASSERT_EQ(plot.series.size(), 3u);
  const PlotSeries &least = plot.series[0], &most = plot.series[1], &mean = plot.series[2];
  ASSERT_EQ(mean.points.size(), 30u);
  for (size_t i = 0; i < mean.points.size(); ++i) {
    const double theta = mean.points[i].x * kPiD / 180;
    double sum = 0;
    for (int k = 0; k < 12; ++k) sum += covered_by_wires(kRadius, theta, 2 * kPiD * k / 12);
    EXPECT_NEAR(mean.points[i].y, sum / 12, 0.02) << mean.points[i].x;
    EXPECT_NEAR(least.points[i].y, 2 * kRadius, 0.02) << "along the wires";
    EXPECT_NEAR(most.points[i].y, covered_by_wires(kRadius, theta, 0), 0.02) << "across them";
  }
}

TEST(OutlinePlot, OfALongTileIsOfAllOfIt) {
  auto volume = test::wires(32, 0.2f);
  volume->aspect = 500;
  EXPECT_NEAR(plotted(with_shell(volume)).series[2].points[0].y, 0.4, 0.04);
}

TEST(OutlinePlot, IsRefusedWithoutAnOutlineAndCanBeCancelled) {
  EXPECT_THROW(plotted(Model{}), Error);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(outline_plot(with_shell(test::wires(16, 0.2f)), progress), Error);
}

}  // namespace
}  // namespace velour::outline_plot_test
