#include "fit/compare.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "brdf/held_out.h"
#include "fit/close_lights.h"
#include "fit/evaluate.h"
#include "fit/noise.h"
#include "fit/view_error.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kComparedLights = 4096;
constexpr uint64_t kLeastLights = 64;  // minimum number of covered lights; fewer say nothing about a view
// Lights that capture less than half or more than twice the energy miss a highlight or take one direction for all of
// it. If fewer than two lights carry the captured energy, the error is that of a single direction.
constexpr double kEnergyFactor = 2, kLeastCarriers = 2;
// For measured materials the error on close lights is 0.7 to 1.1 times that on even lights. Beyond these bounds a
// narrow lobe of the model falls between the even lights.
constexpr double kErrorFactor = 1.5, kErrorSum = 0.01;

std::string key_of(int degrees) { return std::to_string(degrees); }

/// Errors of one reported view, one entry per azimuth.
using AzimuthErrors = std::vector<ViewError>;

/// Mean over the azimuths with at least `least` directions; nothing if there are none.
std::optional<double> mean_error(const AzimuthErrors& errors, uint64_t least) {
  double sum = 0;
  int covered = 0;
  for (const ViewError& e : errors) {
    if (e.count() < least) continue;
    sum += e.relative_l2();
    ++covered;
  }
  return covered > 0 ? std::optional(sum / covered) : std::nullopt;
}

ViewError error_of_view(const Measurement& measurement, const Material& material, const Vec3& wv,
                        const WeightedLights& lights, Progress& progress) {
  const size_t n = lights.wl.size();
  std::vector<Rgb> measured(n), model(n);
  std::vector<uint8_t> valid(n);
  measurement.eval(wv, lights.wl, measured, valid);
  progress.check();
  evaluate(material, wv, lights.wl, model);
  ViewError error;
  for (size_t i = 0; i < n; ++i) {
    if (valid[i]) error.add(lights.weight[i], measured[i], model[i], lights.wl[i].z);
  }
  return error;
}

/// Errors of one reported view on even lights, or on close_lights() if the even ones misjudge energy or error. Writes
/// covered_share and narrow_views of `out`.
AzimuthErrors table_errors(const Measurement& measurement, const Material& material, int degrees, Progress& progress,
                           Comparison& out) {
  const WeightedLights even{hemisphere_fibonacci(kComparedLights),
                            std::vector<double>(kComparedLights, 2 * kPiD / kComparedLights)};
  AzimuthErrors errors, close_errors;
  double seen = 0, energy = 0, covered = 0, carriers = kComparedLights;
  for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
    errors.push_back(error_of_view(measurement, material, wv, even, progress));
    close_errors.push_back(error_of_view(measurement, material, wv, close_lights(material, wv), progress));
    covered += static_cast<double>(errors.back().count()) / kComparedLights;
    seen += errors.back().energy();
    carriers = std::min(carriers, errors.back().carriers());
    energy += close_errors.back().energy();
  }
  out.covered_share[degrees] = covered / static_cast<double>(errors.size());
  const bool even_see_all = seen * kEnergyFactor >= energy && seen <= kEnergyFactor * energy;
  const bool understated =
      mean_error(close_errors, 1).value_or(0) > kErrorFactor * mean_error(errors, 1).value_or(0) + kErrorSum;
  if (energy == 0 || (even_see_all && carriers >= kLeastCarriers && !understated)) return errors;
  out.narrow_views[degrees] = seen / energy;
  return close_errors;
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
      const bool scattered = !measurement.samples().empty();
      const auto errors = scattered ? sample_errors(measurement, material, degrees, progress)
                                    : table_errors(measurement, material, degrees, progress, out);
      entry = mean_error(errors, scattered ? 1 : kLeastLights);
      if (!entry) out.narrow_views.erase(degrees);
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
  // If no view can be judged, an error of 1 is reported rather than a good one.
  out.relative_l2 = weights > 0 ? weighted / weights : 1.0;
  if (out.samples > 0) out.log_rms = std::sqrt(log_sq / static_cast<double>(out.samples));
  return out;
}

}  // namespace velour
