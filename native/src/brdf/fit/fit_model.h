// Fits a measurement with any kind of model. The only place that knows all fits.
#pragma once

#include "base/progress.h"
#include "brdf/fit/options.h"

namespace velour {

/// In the order of Model's bodies; the values are those of VLR_MODEL_*.
enum class ModelKind { per_view = 0, parametric = 1 };

constexpr ModelKind kDefaultModelKind = ModelKind::parametric;

/// options.max_bytes bounds models of either kind; a parametric one is refitted with fewer lobes until it is met.
Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
