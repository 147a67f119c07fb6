#include "brdf/fit/fit_model.h"

#include <algorithm>

#include "base/error.h"
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
  refuse_contradictions(kind, options);
  if (options.for_scene) return bounded_for_scene(measurement, options, progress);
  if (kind == ModelKind::parametric) return bounded_parametric(measurement, options, progress);
  return fit_per_view(measurement, options, progress);
}

}  // namespace velour
