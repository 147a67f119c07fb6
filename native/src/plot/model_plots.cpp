#include "plot/model_plots.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include "base/error.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/fit_report.h"
#include "brdf/measure/held_out.h"
#include "model/model.h"
#include "plot/plot.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

namespace {

void require_brdf(const Model& model, PlotKind kind) {
  if (!is_btf(model)) return;
  throw Error(Status::unsupported,
              "BTF models have no plot '" + std::string(kPlotNames[static_cast<size_t>(kind)]) +
                  "', which shows a single BRDF. Use 'order', or 'outline' if the model has a silhouette (VOTF).");
}

void check_view(const PlotView& view) {
  if (view.theta >= 0 && view.theta < kPiD / 2 && std::isfinite(view.phi)) return;
  throw Error(Status::invalid_argument, "The polar angle of the plot's view is " +
                                            std::to_string(view.theta * 180 / kPiD) +
                                            " degrees; it must be at least 0 and below 90.");
}

}  // namespace

Plot make_plot(PlotKind kind, const std::shared_ptr<const Model>& model, const Measurement* measurement,
               const PlotView& view, Progress& progress) {
  progress.stage("plotting", 0, 1);
  if (kind == PlotKind::order) return order_plot(*model);
  if (kind == PlotKind::outline) return outline_plot(*model, progress);
  require_brdf(*model, kind);
  if (kind == PlotKind::view_error) return view_error_plot(model->fit);
  check_view(view);
  if (kind == PlotKind::lobes) return lobes_plot(model, measurement, view);
  return albedo_plot(*make_material(model, 0), measurement, view.phi, progress);
}

namespace {

/// Sets a logarithmic range of the errors above 0. Zeros (a black material) are drawn at the low end.
void set_error_range(std::vector<double> errors, PlotAxis& axis) {
  std::erase_if(errors, [](double error) { return !(error > 0); });
  if (errors.empty()) return set_logarithmic_range(axis, 0.1, 1);
  const auto [least, largest] = std::ranges::minmax(errors);
  set_logarithmic_range(axis, least, largest);
}

std::vector<double> errors_of(const PlotSeries& series) {
  std::vector<double> errors;
  for (const PlotPoint& p : series.points) errors.push_back(p.y);
  return errors;
}

void add_level(std::vector<PlotPoint> points, Plot& plot) {
  plot.series.insert(plot.series.begin(), {"tolerance", PlotRole::level, PlotMark::dashes, std::move(points)});
  plot.legend.push_back({"tolerance", PlotRole::level, PlotMark::dashes});
}

}  // namespace

Plot order_plot(const Model& model) {
  const bool btf = model.btf.has_value();
  const OrderCurve& order = btf ? model.btf->order : model.fit.order;
  if (order.points.empty()) {
    throw Error(Status::unsupported, "The model does not contain its error for other sizes. Fit it again.");
  }
  Plot plot{.kind = "order"};
  PlotSeries series{"error", PlotRole::model, PlotMark::line_and_dots, {}, order.chosen};
  for (const OrderPoint& p : order.points) {
    series.points.push_back(btf ? PlotPoint{static_cast<double>(p.parameter_bytes), p.relative_l2}
                                : PlotPoint{static_cast<double>(p.lobes), p.worst});
  }
  plot.x = btf ? PlotAxis{"parameter_bytes", "size, bytes"} : PlotAxis{"lobes", "lobes"};
  plot.y =
      btf ? PlotAxis{"relative_l2", "relative L2 error"} : PlotAxis{"worst_over_tolerance", "worst error / tolerance"};
  const auto [first, last] = std::ranges::minmax(series.points, {}, &PlotPoint::x);
  set_logarithmic_range(plot.x, std::max(first.x, 1.0), std::max(last.x, 1.0));
  const double level = btf ? model.btf->tolerance : 1.0;
  std::vector<double> errors = errors_of(series);
  errors.push_back(level);
  set_error_range(std::move(errors), plot.y);
  plot.legend.push_back({"error", PlotRole::model, PlotMark::line_and_dots});
  plot.series.push_back(std::move(series));
  if (level > 0) add_level({{plot.x.low, level}, {plot.x.high, level}}, plot);
  return plot;
}

Plot view_error_plot(const FitRecord& fit) {
  Plot plot{.kind = "view-error"};
  PlotSeries series{"error", PlotRole::model, PlotMark::line_and_dots, {}};
  for (const int degrees : kHeldOutViews) {
    const auto found = fit.by_view_angle.find(std::to_string(degrees));
    if (found != fit.by_view_angle.end() && found->second) {
      series.points.push_back({static_cast<double>(degrees), *found->second});
    }
  }
  if (series.points.empty()) {
    throw Error(Status::unsupported,
                "The model does not contain its error by view angle, because the measurement covers none of the "
                "reported views.");
  }
  plot.x = {"theta_v_degrees", "view angle, degrees", false, 0, 90};
  plot.y = {"relative_l2", "relative L2 error"};
  const auto tolerance = [&](double degrees) { return tolerance_at(fit.tolerance, radians_from(degrees)); };
  std::vector<double> errors = errors_of(series);
  errors.insert(errors.end(), {tolerance(0), tolerance(90)});
  set_error_range(std::move(errors), plot.y);
  plot.legend.push_back({"error", PlotRole::model, PlotMark::line_and_dots});
  plot.series.push_back(std::move(series));
  if (fit.tolerance > 0) {
    add_level({{0, tolerance(0)}, {75, tolerance(75)}, {75, tolerance(90)}, {90, tolerance(90)}}, plot);
  }
  return plot;
}

namespace {

constexpr int kModelStep = 1, kMeasuredStep = 5, kLastAlbedo = 89;  // degrees
// Minimum measured share of the lights for the integral to be an albedo.
constexpr double kMinCovered = 0.95;

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
    if (albedo.covered >= kMinCovered) measured.emplace_back(d, albedo.albedo);
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

namespace {

constexpr int kOutlineStep = 3, kLastOutline = 87;  // degrees
constexpr int kAzimuths = 12;
constexpr uint32_t kTexels = 64;
constexpr float kLongest = 4;  // maximum aspect; longer tiles get no more texels

TileTexels texels_of(const VotfVolume& volume) {
  const float rows = std::clamp(kTexels * volume.aspect, 1.0f, kTexels * kLongest);
  return {kTexels, static_cast<uint32_t>(std::lround(rows)), volume.aspect};
}

double covered(const ShellField& field, const TileTexels& texels, const Vec3& wv) {
  const std::vector<uint8_t> mask = visibility_mask(field, texels, wv);
  return static_cast<double>(std::ranges::count(mask, 1)) / static_cast<double>(mask.size());
}

}  // namespace

Plot outline_plot(const Model& model, Progress& progress) {
  if (!model.shell) throw Error(Status::unsupported, "The model has no silhouette (VOTF) to plot. Add one first.");
  const ShellField field(model.shell->volume);
  const TileTexels texels = texels_of(field.volume());
  PlotSeries least{"least", PlotRole::level, PlotMark::dashes}, most{"most", PlotRole::level, PlotMark::dashes};
  PlotSeries mean{"mean", PlotRole::model, PlotMark::line};
  for (int degrees = 0; degrees <= kLastOutline; degrees += kOutlineStep) {
    double low = 1, high = 0, sum = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      progress.check();
      const double share = covered(field, texels,
                                   direction(radians_from(static_cast<float>(degrees)),
                                             2 * kPi * static_cast<float>(i) / static_cast<float>(kAzimuths)));
      low = std::min(low, share), high = std::max(high, share), sum += share;
    }
    const auto angle = static_cast<double>(degrees);
    least.points.push_back({angle, low});
    most.points.push_back({angle, high});
    mean.points.push_back({angle, sum / kAzimuths});
    progress.update(angle / kLastOutline);
  }
  Plot plot{.kind = "outline"};
  plot.x = {"theta_v_degrees", "view angle, degrees", false, 0, 90};
  plot.y = {"covered", "covered share of the tile", false, 0, 1};
  plot.series = {std::move(least), std::move(most), std::move(mean)};
  plot.legend = {{"azimuthal mean", PlotRole::model, PlotMark::line},
                 {"minimum, maximum", PlotRole::level, PlotMark::dashes}};
  return plot;
}

}  // namespace velour
