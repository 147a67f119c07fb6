#include "fit/fit_model.h"

#include "fit/parametric_fit.h"
#include "fit/scattered_fit.h"

namespace velour {

Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress) {
  if (kind == ModelKind::parametric) return fit_parametric(measurement, options, progress);
  return fit_scattered(measurement, options, progress);
}

}  // namespace velour
