// Closures of a model or a measurement.
#pragma once

#include <memory>
#include <string>
#include "base/progress.h"
#include "brdf/fit/closures/closure_fit.h"
#include "brdf/measure/measurement.h"
#include "model/model.h"

namespace velour {

struct ModelClosures {
  ClosureFit fit;
  double seconds = 0;  // wall clock
  std::string reason;  // a sentence if the error is large
};

/// fit_closures() of a BRDF model. Throws Error(unsupported) for a model of a BTF, and what fit_closures() throws.
ModelClosures fit_model_closures(const std::shared_ptr<const Model>& model, const ClosureFitOptions& options,
                                 Progress& progress);

/// fit_closures() of a measurement. Directions that it does not cover are black.
ModelClosures fit_measurement_closures(const Measurement& measurement, const ClosureFitOptions& options,
                                       Progress& progress);

}  // namespace velour
