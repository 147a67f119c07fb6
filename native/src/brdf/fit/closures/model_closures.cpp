#include "brdf/fit/closures/model_closures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>
#include "base/error.h"
#include "brdf/fit/error/evaluate.h"
#include "model/model_material.h"

namespace velour {

namespace {

constexpr double kLargeClosureError = 0.05;

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// Why the error is large; empty if it is not.
std::string reason_of(const ClosureFit& fit) {
  if (fit.azimuth_error > kLargeClosureError) {
    return "The material is anisotropic, and these closures show its mean over the azimuth, which differs from it by " +
           percent(fit.azimuth_error) + ".";
  }
  if (!(fit.mean_error > kLargeClosureError)) return {};
  const auto worst =
      std::max_element(fit.errors.begin(), fit.errors.end() - 1,  // without 85 degrees, as the mean
                       [](const ClosureViewError& a, const ClosureViewError& b) { return a.luminance < b.luminance; });
  const size_t lobes = fit.network.lobes.size();
  return "The highlights have shapes that " + std::to_string(lobes) +
         (lobes == 1 ? " glossy closure" : " glossy closures") + " cannot take, above all at " +
         std::to_string(worst->degrees) + " degrees (" + percent(worst->luminance) + ").";
}

}  // namespace

ModelClosures fit_measurement_closures(const Measurement& measurement, const ClosureFitOptions& options,
                                       Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const ClosureSource source{[&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
                               std::vector<uint8_t> valid(wl.size());
                               measurement.eval(wv, wl, f, valid);
                             },
                             measurement.isotropic()};
  ClosureFit fit = fit_closures(source, options, progress);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string reason = reason_of(fit);
  return {std::move(fit), seconds, std::move(reason)};
}

ModelClosures fit_model_closures(const std::shared_ptr<const Model>& model, const ClosureFitOptions& options,
                                 Progress& progress) {
  if (is_btf(*model)) {
    throw Error(Status::unsupported,
                "The model of \"" + model->source.name +
                    "\" is of a BTF, whose texture closures of one BRDF cannot show; fit closures to "
                    "a model of a BRDF.");
  }
  return fit_measurement_closures(MaterialMeasurement(make_material(model, 0)), options, progress);
}

}  // namespace velour
