#include "brdf/fit/fit_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include "brdf/fit/error/albedo.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/error/measurement_warnings.h"
#include "brdf/fit/view_grid.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

namespace {

// Albedo above which the scale must be wrong: no measurement error doubles the light of a perfect reflector.
constexpr double kWrongScale = 2;

double polar_degrees(const Vec3& w) { return std::acos(std::clamp(static_cast<double>(w.z), -1.0, 1.0)) * 180 / kPiD; }

/// The azimuth of a view for warnings; none for isotropic measurements, whose azimuths have no meaning.
std::vector<double> azimuth_degrees(const Vec3& wv, bool isotropic) {
  if (isotropic) return {};
  return {std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x)) * 180 / kPiD};
}

double largest(const Vec3d& v) { return std::max({v.x, v.y, v.z}); }

void warn_of_errors(const FitRecord& record, std::vector<Warning>& warnings) {
  std::vector<double> missed, errors, not_covered;
  for (const int degrees : kHeldOutViews) {
    const auto error = record.by_view_angle.at(std::to_string(degrees));
    if (!error) {
      not_covered.push_back(degrees);
    } else if (*error > tolerance_at(record.tolerance, radians_from(static_cast<double>(degrees)))) {
      missed.push_back(degrees);
      errors.push_back(*error);
    }
  }
  if (!missed.empty()) {
    warnings.push_back(warning<WarningCode::views_exceed_tolerance>(
        {{"views", missed}, {"errors", errors}, {"tolerance", record.tolerance}}));
  }
  if (!not_covered.empty()) warnings.push_back(warning<WarningCode::views_not_covered>({{"views", not_covered}}));
}

/// One warning for all fitted views beyond the tolerance, so that a difficult material does not bury other warnings.
void warn_of_fitted_views(const std::vector<FittedView>& fitted, const FitOptions& options, bool isotropic,
                          std::vector<Warning>& warnings) {
  constexpr size_t kMaxNamed = 12;
  std::vector<double> views, azimuths;
  size_t missed = 0;
  const FittedView* worst = nullptr;
  for (const FittedView& v : fitted) {
    if (v.relative_l2 <= tolerance_at(options.tolerance, std::acos(std::min(v.wv.z, 1.0f)))) continue;
    if (++missed <= kMaxNamed) {
      views.push_back(polar_degrees(v.wv));
      std::ranges::copy(azimuth_degrees(v.wv, isotropic), std::back_inserter(azimuths));
    }
    if (!worst || v.relative_l2 > worst->relative_l2) worst = &v;
  }
  if (!worst) return;
  warnings.push_back(
      warning<WarningCode::fitted_views_exceed_tolerance>({{"views", views},
                                                           {"azimuths", azimuths},
                                                           {"missed", missed},
                                                           {"fitted", fitted.size()},
                                                           {"lobes", static_cast<uint64_t>(options.max_lobes)},
                                                           {"worst", polar_degrees(worst->wv)},
                                                           {"worst_azimuth", azimuth_degrees(worst->wv, isotropic)},
                                                           {"error", worst->relative_l2},
                                                           {"tolerance", options.tolerance}}));
}

void warn_of_albedo(const Measurement& measurement, const Vec3& wv, FitRecord& record) {
  const double albedo = record.albedo_max, view = polar_degrees(wv);
  const std::vector<double> azimuth = azimuth_degrees(wv, measurement.isotropic());
  const double measured = largest(directional_albedo(measurement, wv).albedo);  // over the lights that it covers
  if (measured > kWrongScale) {
    record.warnings.push_back(
        warning<WarningCode::implausible_albedo>({{"albedo", albedo}, {"view", view}, {"azimuth", azimuth}}));
  } else if (measured > 1) {
    record.warnings.push_back(
        warning<WarningCode::measured_albedo_above_one>({{"albedo", albedo}, {"view", view}, {"azimuth", azimuth}}));
  } else {
    record.warnings.push_back(warning<WarningCode::model_albedo_above_one>(
        {{"albedo", albedo}, {"view", view}, {"azimuth", azimuth}, {"measured", measured}}));
  }
}

void add_albedos(const Measurement& measurement, const Material& material, const std::vector<FittedView>& fitted,
                 FitRecord& record, Progress& progress) {
  for (const int degrees : kHeldOutViews) {
    std::optional<double>& entry = record.albedo_by_view_angle[std::to_string(degrees)];
    if (!record.by_view_angle.at(std::to_string(degrees))) continue;
    double most = 0;
    for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
      most = std::max(most, largest(directional_albedo(material, wv)));
    }
    entry = most;
  }
  Vec3 brightest(0, 0, 1);
  for (const FittedView& v : fitted) {
    progress.check();
    const double albedo = largest(directional_albedo(material, v.wv));
    if (albedo > record.albedo_max) record.albedo_max = albedo, brightest = v.wv;
  }
  if (record.albedo_max > 1) warn_of_albedo(measurement, brightest, record);
}

/// Removes the errors outside `views` and replaces the mean by that of the fitted views.
void forget_errors_outside(const ViewRange& views, const std::vector<FittedView>& fitted, FitRecord& record) {
  for (auto& [degrees, error] : record.by_view_angle) {
    if (!views.holds(radians_from(std::stod(degrees)))) error = std::nullopt;
  }
  double sum = 0, weight = 0;
  for (const FittedView& v : fitted) {
    sum += static_cast<double>(v.wv.z) * v.relative_l2;
    weight += static_cast<double>(v.wv.z);
  }
  record.relative_l2 = sum / std::max(weight, 1e-12);
}

}  // namespace

double tolerance_at(double tolerance, double theta_v) {
  return theta_v <= radians_from(75.0) + 1e-6 ? tolerance : 2 * tolerance;
}

FitRecord report_fit(const Measurement& measurement, const Material& material, const FitOptions& options,
                     const std::vector<FittedView>& fitted, const ViewRange& views, Progress& progress) {
  FitRecord record;
  record.tolerance = options.tolerance;
  record.seed = options.seed;
  record.all_data = options.all_data;
  const Comparison errors = compare(measurement, material, progress);
  record.relative_l2 = errors.relative_l2;
  record.by_view_angle = errors.by_view_angle;
  if (views.whole()) {
    warn_of_errors(record, record.warnings);
    warn_of_fitted_views(fitted, options, measurement.isotropic(), record.warnings);
  } else {
    forget_errors_outside(views, fitted, record);
  }
  add_albedos(measurement, material, fitted, record, progress);
  record.reciprocity = reciprocity_error(material, progress);
  record.measured_reciprocity = reciprocity_error(measurement, progress);
  if (views.whole()) warn_of_measurement(measurement, errors, record);
  return record;
}

namespace {

constexpr int kReciprocityViews = 16, kReciprocityRings = 32, kReciprocitySpokes = 16;

std::vector<Vec3> views(bool isotropic) {
  std::vector<Vec3> out = hemisphere_fibonacci(kReciprocityViews);
  if (!isotropic) return out;
  for (Vec3& v : out) v = Vec3(std::sqrt(1 - v.z * v.z), 0, v.z);
  return out;
}

/// `f(pair)` is the luminance, or nothing if the pair is not covered. Returns nothing if no pair is covered both ways.
template <class Luminance>
std::optional<double> error_of(bool isotropic, const Progress& progress, const Luminance& f) {
  double difference = 0, energy = 0;
  bool covered = false;
  for (const Vec3& wv : views(isotropic)) {
    progress.check();
    const LightGrid lights = light_grid(wv, kReciprocityRings, kReciprocitySpokes);
    for (size_t i = 0; i < lights.wl.size(); ++i) {
      const Vec3& wl = lights.wl[i];
      const std::optional<double> there = f({wl, wv}), back = f({wv, wl});
      if (!there || !back) continue;
      covered = true;
      const double cosines = static_cast<double>(wl.z) * wv.z;
      const double a = *there * cosines, b = *back * cosines;
      difference += lights.weight[i] * (a - b) * (a - b);
      energy += lights.weight[i] * 0.5 * (a * a + b * b);
    }
  }
  if (!covered) return std::nullopt;
  return energy > 0 ? std::sqrt(difference / energy) : 0.0;
}

}  // namespace

double reciprocity_error(const Material& material, const Progress& progress) {
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    evaluate(material, pair.wv, {&pair.wl, 1}, {&value, 1});
    return luminance(value);
  };
  return error_of(material.isotropic(), progress, f).value_or(0);
}

std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress) {
  if (!measurement.samples().empty()) return std::nullopt;
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    uint8_t valid = 0;
    measurement.eval(pair.wv, {&pair.wl, 1}, {&value, 1}, {&valid, 1});
    return valid ? std::optional<double>(luminance(value)) : std::nullopt;
  };
  return error_of(measurement.isotropic(), progress, f);
}

}  // namespace velour
