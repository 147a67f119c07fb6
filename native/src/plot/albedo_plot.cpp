#include "plot/albedo_plot.h"

#include <algorithm>

#include "fit/directional_albedo.h"
#include "plot/axes.h"

namespace velour {
namespace {

constexpr int kModelStep = 1, kMeasuredStep = 5, kLastAlbedo = 89;  // degrees
// Minimum measured share of the lights for the integral to be an albedo.
constexpr double kLeastCovered = 0.95;

struct Channel {
  const char* name;
  PlotRole role;
  int index;
};
constexpr Channel kChannels[] = {{"red", PlotRole::red, 0}, {"green", PlotRole::green, 1}, {"blue", PlotRole::blue, 2}};

void add_channels(const char* of, PlotMark mark, const std::vector<std::pair<int, Vec3d>>& albedos, Plot& plot) {
  for (const Channel& channel : kChannels) {
    PlotSeries series{std::string(of) + " " + channel.name, channel.role, mark, {}};
    for (const auto& [degrees, albedo] : albedos) {
      series.points.push_back({static_cast<double>(degrees), albedo[channel.index]});
    }
    plot.series.push_back(std::move(series));
  }
  plot.legend.push_back({of, PlotRole::text, mark});
}

double largest_of(const Plot& plot) {
  double largest = 0;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& p : series.points) largest = std::max(largest, p.y);
  }
  return largest;
}

}  // namespace

Plot albedo_plot(const Material& material, const Measurement* measurement, double phi, Progress& progress) {
  const auto view = [phi](int degrees) {
    return direction(static_cast<float>(radians_from(static_cast<double>(degrees))), static_cast<float>(phi));
  };
  const double last =
      measurement ? 2.0 * kLastAlbedo : kLastAlbedo;  // views of the model, then those of the measurement
  std::vector<std::pair<int, Vec3d>> modelled, measured;
  for (int d = 0; d <= kLastAlbedo; d += kModelStep) {
    progress.check();
    modelled.emplace_back(d, directional_albedo(material, view(d)));
    progress.update(d / last);
  }
  for (int d = 0; measurement && d <= kLastAlbedo; d += kMeasuredStep) {
    progress.check();
    progress.update((kLastAlbedo + d) / last);
    if (!measurement->covers_view(static_cast<float>(radians_from(static_cast<double>(d))))) continue;
    const MeasuredAlbedo albedo = directional_albedo(*measurement, view(d));
    if (albedo.covered >= kLeastCovered) measured.emplace_back(d, albedo.albedo);
  }
  progress.update(1.0);
  Plot plot{.kind = "albedo"};
  plot.x = {"theta_v_degrees", "view angle, degrees", false, 0, 90};
  plot.y = {"albedo", "albedo"};
  add_channels("model", PlotMark::line, modelled, plot);
  if (!measured.empty()) add_channels("measured", PlotMark::dots, measured, plot);
  const double largest = largest_of(plot);
  set_linear_range(plot.y, largest > 0 ? largest : 1);
  if (largest > 1) {
    plot.series.insert(plot.series.begin(), {"all light", PlotRole::level, PlotMark::dashes, {{0, 1}, {90, 1}}});
    plot.legend.push_back({"albedo 1", PlotRole::level, PlotMark::dashes});
  }
  return plot;
}

}  // namespace velour
