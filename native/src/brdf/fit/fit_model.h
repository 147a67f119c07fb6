// Fits a measurement with any kind of model. The only place that knows all fits.
#pragma once

#include "base/progress.h"
#include "brdf/fit/options.h"

namespace velour {

/// The values are those of VLR_MODEL_*.
enum class ModelKind { per_view = 0, parametric = 1, automatic = 2 };

constexpr ModelKind kDefaultModelKind = ModelKind::automatic;

/// options.max_bytes bounds models of either kind; a parametric one is refitted with fewer lobes until it is met.
///
/// Automatic: parametric, unless a reported view misses its tolerance several times over. Then the fit continues with
/// splines twice as fine, and if that does not help, a per-view model follows. A larger model must lower the errors by
/// a third. Options that only one kind has, and bounds of the size, decide by themselves.
Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
