// Closures of Blender fitted to a model.
#include "brdf/fit/closures/model_closures.h"
#include "capi/fit_reports.h"
#include "capi/guard.h"
#include "capi/handles.h"

using namespace velour;
using namespace velour::capi;

void vlr_closure_options_init(vlr_closure_options* options) {
  const ClosureFitOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_closure_options);
  options->masking = static_cast<int32_t>(defaults.masking);
}

namespace {

ClosureFitOptions converted(const vlr_closure_options& given) {
  require_choice(given.masking, VLR_MASKING_CORRELATED, "vlr_closure_options.masking");
  ClosureFitOptions options;
  if (given.max_lobes != 0) options.max_lobes = static_cast<int>(std::min(given.max_lobes, 1000u));
  if (given.tolerance != 0) options.tolerance = given.tolerance;
  options.masking = static_cast<LobeMasking>(given.masking);
  options.threads = static_cast<int>(given.threads);
  return options;
}

}  // namespace

vlr_status vlr_model_closures_json(vlr_model* model, const vlr_closure_options* options, const char** json) {
  return guard([&] {
    require(model, "model");
    require(json, "json");
    const ClosureFitOptions fit = converted(read_options(options, vlr_closure_options_init, "vlr_closure_options"));
    Progress progress;
    model->closures = closures_json(fit_model_closures(kept(model->model), fit, progress));
    *json = model->closures.c_str();
  });
}
