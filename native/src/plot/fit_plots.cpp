#include "plot/fit_plots.h"

#include <algorithm>
#include <utility>

#include "brdf/held_out.h"
#include "fit/fit_report.h"
#include "job/error.h"
#include "plot/axes.h"

namespace velour {
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

}  // namespace velour
