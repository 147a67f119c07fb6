#include "capi/conversions.h"

#include "brdf/fit/per_view/per_view_fit.h"
#include "btf/eval/measured_btf_material.h"
#include "btf/eval/sided_btf_material.h"
#include "material/derived_materials.h"
#include "model/model.h"

namespace velour::capi {
namespace {

/// Lobes to sample from for a raw measurement. Their fit affects the speed but not the image, so a coarse fit of all
/// data suffices.
std::shared_ptr<const Model> coarse_proposal(const Measurement& measurement) {
  FitOptions options;
  options.max_lobes = 8;
  options.tolerance = 0.05;
  options.all_data = true;
  Progress unwatched;
  return std::make_shared<const Model>(fit_per_view(measurement, options, unwatched));
}

SurfaceMaterial brushed_if_anisotropic(SurfaceMaterial surface) {
  surface.brushed = !surface.material->isotropic() && !surface.material->varies();
  return surface;
}

}  // namespace

SurfaceMaterial surface_of(const std::shared_ptr<const Model>& model, uint32_t neighbors) {
  SurfaceMaterial surface{.material = make_material(model, static_cast<int>(neighbors))};
  if (!model->shell) return brushed_if_anisotropic(std::move(surface));
  surface.shell = std::make_shared<const ShellField>(model->shell->volume);
  surface.shell_shaded = !is_btf(*model);
  if (surface.holed()) surface.material = std::make_shared<const HoledBtfMaterial>(surface.material);
  return surface;
}

SurfaceMaterial surface_of(std::shared_ptr<const Measurement> measurement, std::shared_ptr<const Model> proposal,
                           uint32_t neighbors) {
  if (!proposal) proposal = coarse_proposal(*measurement);
  return brushed_if_anisotropic(
      {.material = make_measured_material(std::move(measurement), proposal, static_cast<int>(neighbors))});
}

SurfaceMaterial surface_of(const BtfMeasurement& btf, uint64_t most_bytes) {
  const auto table = read_btf_table(btf, most_bytes != 0 ? most_bytes : kUsualTableBytes);
  auto reflecting = make_measured_btf_material(table);
  if (!table->between.knows_through()) return {.material = std::move(reflecting)};
  return {.material = std::make_shared<const ThroughMaterial>(std::move(reflecting),
                                                              make_measured_btf_material(table, BtfLight::other_side))};
}

}  // namespace velour::capi
