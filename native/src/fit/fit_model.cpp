#include "fit/fit_model.h"

#include "job/error.h"

namespace velour {

Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress) {
  switch (kind) {
    case ModelKind::parametric:
      throw Error(Status::unsupported, "Parametric models cannot be fitted yet.");
    case ModelKind::scattered:
      break;
  }
  return fit_scattered(measurement, options, progress);
}

}  // namespace velour
