#include "plot/model_plots.h"

#include "job/error.h"
#include "model/model_material.h"
#include "plot/albedo_plot.h"
#include "plot/fit_plots.h"
#include "plot/lobes_plot.h"
#include "plot/outline_plot.h"

namespace velour {
namespace {

void require_brdf(const Model& model, PlotKind kind) {
  if (!is_btf(model)) return;
  throw Error(Status::unsupported,
              "BTF models have no plot '" + std::string(kPlotNames[static_cast<size_t>(kind)]) +
                  "', which shows a single BRDF. Use 'order', or 'outline' if the model has a silhouette (VOTF).");
}

void check_view(const PlotView& view) {
  if (view.theta >= 0 && view.theta < kPiD / 2 && std::isfinite(view.phi)) return;
  throw Error(Status::invalid_argument, "The polar angle of the plot's view is " +
                                            std::to_string(view.theta * 180 / kPiD) +
                                            " degrees; it must be at least 0 and below 90.");
}

}  // namespace

Plot make_plot(PlotKind kind, const std::shared_ptr<const Model>& model, const Measurement* measurement,
               const PlotView& view, Progress& progress) {
  progress.stage("plotting", 0, 1);
  if (kind == PlotKind::order) return order_plot(*model);
  if (kind == PlotKind::outline) return outline_plot(*model, progress);
  require_brdf(*model, kind);
  if (kind == PlotKind::view_error) return view_error_plot(model->fit);
  check_view(view);
  if (kind == PlotKind::lobes) return lobes_plot(model, measurement, view);
  return albedo_plot(*make_material(model, 0), measurement, view.phi, progress);
}

}  // namespace velour
