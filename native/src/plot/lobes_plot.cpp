#include "plot/model_plots.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include "brdf/eval/per_view_lobes.h"
#include "brdf/fit/error/evaluate.h"
#include "model/model.h"
#include "plot/plot.h"

namespace velour {

namespace {

constexpr double kCurveStep = 0.2;  // degrees
// Around the mirror and the view direction, steps grow from kFinest, so that the narrowest highlight has points.
constexpr double kFinest = 0.002, kGrowth = 1.3;
// A peak of this many times the mean hides the rest on a linear radius.
constexpr double kPeakyness = 8;
constexpr double kFewestDecades = 2, kMaxDecades = 4;

/// Signed angles in degrees, sorted.
std::vector<double> plotted_angles(double view_degrees) {
  std::vector<double> angles;
  const int steps = static_cast<int>(std::lround(180 / kCurveStep));
  for (int k = 1; k < steps; ++k) angles.push_back(-90 + 180.0 * k / steps);
  for (const double peak : {view_degrees, -view_degrees}) {
    angles.push_back(peak);
    for (double away = kFinest; away < 2; away *= kGrowth) {
      angles.push_back(peak - away);
      angles.push_back(peak + away);
    }
  }
  std::erase_if(angles, [](double a) { return std::abs(a) >= 90; });
  std::ranges::sort(angles);
  return angles;
}

double luminance_of(const Vec3d& c) { return kLuminance[0] * c.x + kLuminance[1] * c.y + kLuminance[2] * c.z; }

struct NamedLobe {
  std::string name;
  std::function<double(const Vec3d& wl)> f_cos;
};

/// Lobes as mixed by the material for the view: those of neighboring views with their weights.
std::vector<NamedLobe> lobes_of(const PerViewBrdf& brdf, const Vec3& wv) {
  const auto mixed = std::make_shared<LobeMixture>();
  const PerViewLobes of_views(brdf, 0);
  of_views.gather(of_views.place(wv), *mixed);
  const LobeMixture& m = *mixed;
  std::vector<NamedLobe> lobes;
  for (int j = 0; j < m.count; ++j) {
    lobes.push_back({"lobe " + std::to_string(j + 1), [mixed, j](const Vec3d& wl) {
                       const LobeMixture& mixture = *mixed;
                       const Vec3d center(mixture.x[j], mixture.y[j], mixture.z[j]);
                       return luminance(Rgb(mixture.r[j], mixture.g[j], mixture.b[j])) *
                              kernel_value(mixture.kernel, mixture.bandwidth[j], one_minus_dot(wl, center));
                     }});
  }
  if (const Rgb diffuse(m.diffuse_r, m.diffuse_g, m.diffuse_b); luminance(diffuse) > 0) {
    lobes.push_back({"cosine", [diffuse](const Vec3d& wl) { return luminance(diffuse) * std::max(wl.z, 0.0); }});
  }
  return lobes;
}

double f_of(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  return luminance_of(lobe.coefficient) * warped_kernel(lobe, wl, wv);
}

std::vector<NamedLobe> lobes_of(const ParametricBrdf& brdf, const Vec3& view) {
  const Vec3d wv(view);
  const auto lobes_here = std::make_shared<std::vector<WarpedLobe>>(lobes_at(brdf, wv));
  std::vector<NamedLobe> lobes;
  for (size_t j = 0; j < lobes_here->size(); ++j) {
    lobes.push_back({"lobe " + std::to_string(j + 1), [&brdf, lobes_here, wv, j](const Vec3d& wl) {
                       const double f = f_of((*lobes_here)[j], wl, wv);
                       if (!brdf.symmetric) return f * wl.z;
                       return 0.5 * (f + f_of(lobes_at(brdf, wl)[j], wv, wl)) * wl.z;
                     }});
  }
  return lobes;
}

template <typename Body>
std::vector<NamedLobe> lobes_of(const Body& /*a BTF's*/, const Vec3& /*wv*/) {
  return {};
}

/// Null for a parametric model: preparing its sampling would take half a second per view, and its value is a formula.
std::shared_ptr<const Material> material_for_values(const std::shared_ptr<const Model>& model) {
  return std::holds_alternative<ParametricBrdf>(model->body) ? nullptr : make_material(model, 0);
}

std::vector<PlotPoint> model_points(const Model& model, const Material* material, const Vec3& wv, const PlotView& view,
                                    const std::vector<double>& angles) {
  std::vector<Vec3> wl;
  for (const double angle : angles) wl.push_back(light_in_plane(angle, view.phi));
  std::vector<Rgb> f(wl.size());
  if (material) {
    evaluate(*material, wv, wl, f);
  } else {
    const auto& brdf = std::get<ParametricBrdf>(model.body);
    for (size_t i = 0; i < wl.size(); ++i) f[i] = Rgb(value_of(brdf, Vec3d(wl[i]), Vec3d(wv)));
  }
  std::vector<PlotPoint> points;
  for (size_t i = 0; i < wl.size(); ++i) points.push_back({angles[i], static_cast<double>(luminance(f[i]) * wl[i].z)});
  return points;
}

void set_radius(const PlotSeries& model, const std::vector<PlotPoint>& measured, PlotAxis& axis) {
  double largest = 0, sum = 0, least = 0;
  for (const PlotPoint& p : model.points) largest = std::max(largest, p.y);
  // Trapezoidal rule: the angles are not evenly spaced, because the peaks have points of their own.
  const size_t count = model.points.size();
  for (size_t i = 1; i < count; ++i) {
    sum += 0.5 * (model.points[i - 1].y + model.points[i].y) * (model.points[i].x - model.points[i - 1].x);
  }
  for (const PlotPoint& p : measured) largest = std::max(largest, p.y);
  if (!(largest > 0)) return set_linear_range(axis, 1);
  const double mean = sum / 180;
  if (largest <= kPeakyness * mean) return set_linear_range(axis, largest);
  std::vector<double> values;
  for (const PlotPoint& p : model.points) {
    if (p.y > 0 && std::abs(p.x) < 80) values.push_back(p.y);
  }
  std::ranges::sort(values);
  least = values.empty() ? largest : values[values.size() / 20];
  const double high = std::ceil(std::log10(largest) - 1e-9);
  const double low = std::clamp(std::floor(std::log10(least)), high - kMaxDecades, high - kFewestDecades);
  axis.logarithmic = true;
  axis.low = std::pow(10.0, low);
  axis.high = std::pow(10.0, high);
}

void add_lobes(const Model& model, const Vec3& wv, const PlotView& view, const std::vector<double>& angles,
               Plot& plot) {
  const auto lobes = std::visit([&](const auto& body) { return lobes_of(body, wv); }, model.body);
  for (const NamedLobe& lobe : lobes) {
    PlotSeries series{lobe.name, PlotRole::lobe, PlotMark::line, {}};
    for (const double angle : angles) {
      series.points.push_back({angle, lobe.f_cos(Vec3d(light_in_plane(angle, view.phi)))});
    }
    plot.series.push_back(std::move(series));
  }
  if (!lobes.empty()) plot.legend.push_back({"lobes", PlotRole::lobe, PlotMark::line});
}

}  // namespace

Plot lobes_plot(const std::shared_ptr<const Model>& model, const Measurement* measurement, const PlotView& view) {
  const auto material = material_for_values(model);
  const Vec3 wv = direction(static_cast<float>(view.theta), static_cast<float>(view.phi));
  const double degrees = view.theta * 180 / kPiD;
  const std::vector<double> angles = plotted_angles(degrees);
  Plot plot{.kind = "lobes", .polar = true};
  plot.x = {"theta_l_degrees", "light angle, degrees", false, -90, 90};
  plot.y = {"f_cos_per_sr", "f cos \u03b8, 1/sr"};
  PlotSeries total{"model", PlotRole::model, PlotMark::line, model_points(*model, material.get(), wv, view, angles)};
  plot.legend.push_back({"model", PlotRole::model, PlotMark::line});
  add_lobes(*model, wv, view, angles, plot);
  PlotSeries measured{"measured", PlotRole::measured, PlotMark::dots, {}};
  if (measurement) measured.points = measured_points(*measurement, view);
  set_radius(total, measured.points, plot.y);
  plot.series.push_back(std::move(total));
  if (!measured.points.empty()) {
    plot.legend.push_back({"measured", PlotRole::measured, PlotMark::dots});
    plot.series.push_back(std::move(measured));
  }
  plot.series.push_back({"view", PlotRole::text, PlotMark::dashes, {{-degrees, plot.y.low}, {-degrees, plot.y.high}}});
  plot.legend.push_back({"view at " + tick_text(degrees) + "\u00b0", PlotRole::text, PlotMark::dashes});
  return plot;
}

namespace {

constexpr double kNear = 2.5;  // degrees
constexpr int kPointStep = 2, kLastPoint = 88;

double degrees_from(double radians) { return radians * 180 / kPiD; }

std::vector<double> table_angles(double view_degrees) {
  std::vector<double> angles;
  for (int a = -kLastPoint; a <= kLastPoint; a += kPointStep) angles.push_back(a);
  for (const double away : {0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0}) {
    angles.push_back(view_degrees - away);
    angles.push_back(view_degrees + away);
  }
  std::erase_if(angles, [](double a) { return std::abs(a) > kLastPoint; });
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

std::vector<PlotPoint> table_points(const Measurement& measurement, const PlotView& view) {
  const auto theta = static_cast<float>(view.theta);
  if (!measurement.covers_view(theta)) return {};
  const std::vector<double> angles = table_angles(degrees_from(view.theta));
  std::vector<Vec3> wl;
  for (const double angle : angles) wl.push_back(light_in_plane(angle, view.phi));
  std::vector<Rgb> f(wl.size());
  std::vector<uint8_t> valid(wl.size());
  measurement.eval(direction(theta, static_cast<float>(view.phi)), wl, f, valid);
  std::vector<PlotPoint> points;
  for (size_t i = 0; i < wl.size(); ++i) {
    if (valid[i]) points.push_back({angles[i], static_cast<double>(luminance(f[i]) * wl[i].z)});
  }
  return points;
}

/// Rotates `w` about the normal so that azimuth `phi` becomes that of +x.
Vec3d turned_back(const Vec3& w, double phi) {
  const double c = std::cos(phi), s = std::sin(phi);
  return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
}

std::vector<PlotPoint> sample_points(const Measurement& measurement, const PlotView& view) {
  std::vector<PlotPoint> points;
  for (const IrregularSample& sample : measurement.samples()) {
    const double theta = std::acos(std::clamp(static_cast<double>(sample.wv.z), -1.0, 1.0));
    if (std::abs(degrees_from(theta - view.theta)) > kNear) continue;
    // For isotropic data, all planes of incidence are equivalent.
    const double phi = measurement.isotropic() ? std::atan2(static_cast<double>(sample.wv.y), sample.wv.x) : view.phi;
    const Vec3d wv = turned_back(sample.wv, phi), wl = turned_back(sample.wl, phi);
    const double off_plane = degrees_from(std::asin(std::clamp(std::abs(wl.y), 0.0, 1.0)));
    const double off_view = degrees_from(std::asin(std::clamp(std::abs(wv.y), 0.0, 1.0)));
    if (off_plane > kNear || off_view > kNear || (wv.x < 0 && view.theta > radians_from(kNear))) continue;
    points.push_back({degrees_from(std::atan2(-wl.x, wl.z)), static_cast<double>(luminance(sample.f)) * wl.z});
  }
  std::ranges::sort(points, {}, &PlotPoint::x);
  return points;
}

}  // namespace

Vec3 light_in_plane(double degrees, double phi) {
  const double theta = radians_from(degrees);
  return Vec3(Vec3d(-std::sin(theta) * std::cos(phi), -std::sin(theta) * std::sin(phi), std::cos(theta)));
}

std::vector<PlotPoint> measured_points(const Measurement& measurement, const PlotView& view) {
  return measurement.samples().empty() ? table_points(measurement, view) : sample_points(measurement, view);
}

}  // namespace velour
