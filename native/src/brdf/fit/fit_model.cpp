#include "brdf/fit/fit_model.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/error.h"
#include "brdf/fit/fit_report.h"
#include "brdf/fit/parametric/parametric_fit.h"
#include "brdf/fit/per_view/per_view_fit.h"
#include "brdf/fit/scene_fit.h"

namespace velour {
namespace {

uint64_t size_of_parametric(const Model& model, const FitOptions& options) {
  return options.size_of ? options.size_of(model) : std::get<ParametricBrdf>(model.body).parameter_bytes();
}

[[noreturn]] void refuse_bound(const FitOptions& options, const char* of_what, uint64_t smallest) {
  throw Error(Status::invalid_argument, "The fit's max_bytes is " + std::to_string(options.max_bytes) +
                                            ", but the smallest model " + of_what + " takes " +
                                            std::to_string(smallest) + " bytes. Raise the maximum size.");
}

/// A scene model is already as small as its error allows, so the bound is only checked.
Model bounded_for_scene(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  Model model = fit_for_scene(measurement, options, progress);
  const uint64_t size = size_of_parametric(model, options);
  if (options.max_bytes > 0 && size > options.max_bytes) refuse_bound(options, "for this scene", size);
  return model;
}

/// Refits with fewer lobes until the model is within options.max_bytes: its size is known only once it is encoded.
Model bounded_parametric(const Measurement& measurement, FitOptions options, Progress& progress) {
  while (true) {
    Model model = fit_parametric(measurement, options, progress);
    const uint64_t size = size_of_parametric(model, options);
    if (options.max_bytes == 0 || size <= options.max_bytes) return model;
    const auto& brdf = std::get<ParametricBrdf>(model.body);
    if (brdf.lobe_count() <= 1) refuse_bound(options, "of this measurement", size);
    const uint64_t lobe = brdf.parameter_bytes() / brdf.space.size();
    const auto excess = static_cast<int>(std::min<uint64_t>((size - options.max_bytes) / lobe + 1, brdf.kMaxLobes));
    options.max_lobes = std::max(1, brdf.lobe_count() - excess);
  }
}

// A model is kept if no reported view misses its tolerance by more than this factor, and its pictures look like the
// measurement's. Another of the same verdict must have a mean error smaller by the second factor, or pictures whose
// differences are smaller by the third.
constexpr double kGoodEnough = 5, kWorthIt = 1.5, kWorthSeeing = 1.25;

/// Largest error of the reported views in units of their tolerances.
double worst_miss(const FitRecord& record) {
  double worst = 0;
  for (const auto& [degrees, error] : record.by_view_angle) {
    if (error) worst = std::max(worst, *error / tolerance_at(record.tolerance, radians_from(std::stod(degrees))));
  }
  return worst;
}

/// Whether a larger model is worth a try.
bool is_poor(const Measurement& measurement, const FitRecord& record) {
  if (record.verdict && record.verdict->quality != LookQuality::good) return true;
  if (measurement.samples().empty()) return worst_miss(record) > kGoodEnough;
  // The error of irregular samples is mostly their noise, unless the model is worse than black.
  return std::ranges::any_of(record.by_view_angle, [](const auto& view) { return view.second.value_or(0.0) > 1.0; });
}

/// Whether a larger model is worth its size.
bool is_better(const Measurement& measurement, const FitRecord& larger, const FitRecord& smaller) {
  const bool is_closer = larger.relative_l2 < smaller.relative_l2;
  if (!larger.verdict || !smaller.verdict) return kWorthIt * larger.relative_l2 < smaller.relative_l2;
  const bool is_table = measurement.samples().empty();  // errors of irregular samples are mostly noise
  if (is_table && larger.relative_l2 > kWorthIt * smaller.relative_l2) return false;
  if (larger.verdict->quality != smaller.verdict->quality) return larger.verdict->quality < smaller.verdict->quality;
  return kWorthIt * larger.relative_l2 < smaller.relative_l2 ||
         (is_closer && kWorthSeeing * larger.verdict->flip_mean < smaller.verdict->flip_mean);
}

/// Options that only one of the kinds has decide. Nothing if any kind will do.
std::optional<ModelKind> required_kind(const FitOptions& options) {
  if (options.kernel != Kernel::gaussian) return ModelKind::per_view;
  const bool is_bounded = options.max_bytes > 0 || options.max_lobes < FitOptions().max_lobes;
  const bool parametric = options.for_scene || options.limit_albedo || options.symmetric || is_bounded;
  return parametric ? std::optional(ModelKind::parametric) : std::nullopt;
}

Model fit_automatically(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto judged = [&](Model model) {
    if (options.verdict_on) model.fit.verdict = options.verdict_on(model, progress);
    return model;
  };
  Model best;
  {
    const Progress::Span span(progress, 0.0, 0.4);
    best = judged(fit_parametric(measurement, options, progress));
  }
  const auto replace_if_better = [&](Model other) {
    if (is_better(measurement, other.fit, best.fit)) best = std::move(other);
  };
  const auto& coarse = std::get<ParametricBrdf>(best.body);
  const bool table = measurement.samples().empty();  // irregular samples are too few for more cells
  if (table && measurement.isotropic() && coarse.lobe_count() > 0 && is_poor(measurement, best.fit)) {
    const Progress::Span span(progress, 0.4, 0.7);
    replace_if_better(judged(fit_finer(measurement, coarse, options, progress)));
  }
  if (is_poor(measurement, best.fit)) {
    const Progress::Span span(progress, 0.7, 1.0);
    replace_if_better(judged(fit_per_view(measurement, options, progress)));
  }
  best.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.stage("checking the model", 1.0, 1.0);
  return best;
}

void refuse_contradictions(ModelKind kind, const FitOptions& options) {
  const auto refuse = [](const char* sentence) { throw Error(Status::invalid_argument, sentence); };
  if (kind != ModelKind::parametric) {
    if (options.for_scene) refuse("Only parametric models can be reduced to a scene.");
    if (options.limit_albedo) refuse("The albedo can only be limited for parametric models.");
    if (options.symmetric) refuse("Only parametric models can be made reciprocal (symmetric).");
  } else if (options.for_scene && options.symmetric) {
    refuse(
        "A scene model cannot be made reciprocal (symmetric), because it covers only the views of the scene and not "
        "its light directions.");
  }
}

}  // namespace

Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress) {
  if (kind == ModelKind::automatic) {
    const std::optional<ModelKind> required = required_kind(options);
    if (!required) return fit_automatically(measurement, options, progress);
    kind = *required;
  }
  refuse_contradictions(kind, options);
  if (options.for_scene) return bounded_for_scene(measurement, options, progress);
  if (kind == ModelKind::parametric) return bounded_parametric(measurement, options, progress);
  return fit_per_view(measurement, options, progress);
}

}  // namespace velour
