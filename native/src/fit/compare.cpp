#include "fit/compare.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "brdf/held_out.h"
#include "fit/evaluate.h"
#include "fit/noise.h"
#include "fit/view_error.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kLights = 4096;

std::string key_of(int degrees) { return std::to_string(degrees); }

/// Errors of one reported view, one entry an azimuth.
using AzimuthErrors = std::vector<ViewError>;

/// Mean over the azimuths that hold data; nothing when none does.
std::optional<double> mean_error(const AzimuthErrors& errors) {
  double sum = 0;
  int covered = 0;
  for (const ViewError& e : errors) {
    if (e.count() == 0) continue;
    sum += e.relative_l2();
    ++covered;
  }
  return covered > 0 ? std::optional(sum / covered) : std::nullopt;
}

ViewError error_of_view(const Measurement& measurement, const Material& material, const Vec3& wv,
                        std::span<const Vec3> lights, Progress& progress) {
  std::vector<Rgb> measured(lights.size()), model(lights.size());
  std::vector<uint8_t> valid(lights.size());
  measurement.eval(wv, lights, measured, valid);
  progress.check();
  evaluate(material, wv, lights, model);
  ViewError error;
  for (size_t i = 0; i < lights.size(); ++i) {
    if (valid[i]) error.add(2 * kPiD / kLights, measured[i], model[i], lights[i].z);
  }
  return error;
}

AzimuthErrors table_errors(const Measurement& measurement, const Material& material, int degrees, Progress& progress) {
  const std::vector<Vec3> lights = hemisphere_fibonacci(kLights);
  AzimuthErrors errors;
  for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
    errors.push_back(error_of_view(measurement, material, wv, lights, progress));
  }
  return errors;
}

AzimuthErrors sample_errors(const Measurement& measurement, const Material& material, int degrees, Progress& progress) {
  ViewError error;
  const auto samples = measurement.samples();
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % 1024 == 0) progress.check();
    const ScatteredSample& s = samples[i];
    if (!held_out_sample(i) || reported_view_of(s.wv) != degrees) continue;
    Rgb model;
    evaluate(material, s.wv, {&s.wl, 1}, {&model, 1});
    error.add(1, s.f, model, s.wl.z);
  }
  return {error};
}

}  // namespace

Comparison compare(const Measurement& measurement, const Material& material, Progress& progress) {
  Comparison out;
  double weighted = 0, weights = 0, log_sq = 0;
  int done = 0;
  for (const int degrees : kHeldOutViews) {
    std::optional<double>& entry = out.by_view_angle[key_of(degrees)];
    if (measurement.covers_view(static_cast<float>(radians_from(static_cast<double>(degrees))))) {
      const auto errors = measurement.samples().empty() ? table_errors(measurement, material, degrees, progress)
                                                        : sample_errors(measurement, material, degrees, progress);
      entry = mean_error(errors);
      for (const ViewError& e : errors) {
        log_sq += e.log_sq_sum();
        out.samples += e.count();
      }
    }
    if (entry) {
      const double weight = std::cos(radians_from(static_cast<double>(degrees)));
      weighted += weight * *entry;
      weights += weight;
    }
    out.noise_by_view_angle[key_of(degrees)] = entry ? noise_of_view(measurement, degrees, progress) : std::nullopt;
    progress.update(++done / static_cast<double>(kHeldOutViews.size()));
  }
  if (weights > 0) out.relative_l2 = weighted / weights;
  if (out.samples > 0) out.log_rms = std::sqrt(log_sq / static_cast<double>(out.samples));
  return out;
}

}  // namespace velour
