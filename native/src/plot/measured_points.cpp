#include "plot/measured_points.h"

#include <algorithm>
#include <cmath>

namespace velour {
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
  for (const ScatteredSample& sample : measurement.samples()) {
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
