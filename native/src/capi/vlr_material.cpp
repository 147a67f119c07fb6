// Materials of a scene and their settings.
#include "brdf/fit/per_view/per_view_fit.h"
#include "btf/eval/measured_btf_material.h"
#include "btf/eval/sided_btf_material.h"
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "material/principled/principled_point.h"
#include "material/through_material.h"
#include "model/model_material.h"

using namespace velour;
using namespace velour::capi;

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

SurfaceMaterial surface_of(std::shared_ptr<const Model> model, uint32_t neighbors) {
  SurfaceMaterial surface{.material = make_material(model, static_cast<int>(neighbors))};
  if (!model->shell) return brushed_if_anisotropic(std::move(surface));
  surface.shell = std::make_shared<const ShellField>(model->shell->volume);
  surface.shell_shaded = !is_btf(*model);
  if (surface.holed()) surface.material = std::make_shared<const HoledBtfMaterial>(surface.material);
  return surface;
}

/// Material of the BTF itself, including transmitted light if the BTF has it.
std::shared_ptr<const Material> make_lit_from_both(const std::shared_ptr<const BtfTable>& table) {
  auto reflecting = make_measured_btf_material(table);
  if (!table->between.knows_through()) return reflecting;
  return std::make_shared<const ThroughMaterial>(std::move(reflecting),
                                                 make_measured_btf_material(table, BtfLight::other_side));
}

}  // namespace

vlr_status vlr_scene_add_model_material(vlr_scene* scene, const vlr_model* model, uint32_t neighbors,
                                        uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(model, "model");
    require(material, "material");
    *material = scene->scene->add_material(surface_of(kept(model->model), neighbors));
  });
}

vlr_status vlr_scene_set_model_material(vlr_scene* scene, uint32_t material, const vlr_model* model,
                                        uint32_t neighbors) {
  return guard([&] {
    require(scene, "scene");
    require(model, "model");
    scene->scene->set_material(material, surface_of(kept(model->model), neighbors));
  });
}

vlr_status vlr_scene_add_measurement_material(vlr_scene* scene, const vlr_measurement* measurement,
                                              const vlr_model* proposal, uint32_t neighbors, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(measurement, "measurement");
    require(material, "material");
    const auto measured = kept(measurement->measurement);
    const auto model = proposal ? kept(proposal->model) : coarse_proposal(*measured);
    *material = scene->scene->add_material(
        brushed_if_anisotropic({.material = make_measured_material(measured, model, static_cast<int>(neighbors))}));
  });
}

vlr_status vlr_scene_add_btf_material(vlr_scene* scene, const vlr_btf* btf, uint64_t most_bytes, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(btf, "btf");
    require(material, "material");
    auto table = read_btf_table(*kept(btf->btf), most_bytes != 0 ? most_bytes : kUsualTableBytes);
    *material = scene->scene->add_material({.material = make_lit_from_both(std::move(table))});
  });
}

void vlr_principled_desc_init(vlr_principled_desc* desc) {
  const PrincipledParameters defaults;
  *desc = {};
  desc->struct_size = sizeof(vlr_principled_desc);
  for (int i = 0; i < 3; ++i) desc->base_color[i] = defaults.base_color[i];
  desc->metallic = defaults.metallic;
  desc->roughness = defaults.roughness;
  desc->specular = defaults.specular;
  desc->formula = static_cast<int32_t>(defaults.formula);
  desc->lobe = static_cast<int32_t>(defaults.lobe);
  desc->alpha = 1.0f;
  for (int i = 0; i < 3; ++i) desc->specular_tint[i] = defaults.specular_tint[i];
  desc->coat = defaults.coat;
  desc->coat_roughness = defaults.coat_roughness;
  desc->coat_index = defaults.coat_index;
  for (int i = 0; i < 3; ++i) desc->coat_tint[i] = defaults.coat_tint[i];
  desc->coat_lobe = static_cast<int32_t>(defaults.coat_lobe);
}

vlr_status vlr_scene_add_principled_material(vlr_scene* scene, const vlr_principled_desc* desc, uint32_t* material) {
  return vlr_scene_add_textured_material(scene, desc, nullptr, material);
}

vlr_status vlr_scene_replace_material(vlr_scene* scene, uint32_t material) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->replace_material(material);
  });
}

vlr_status vlr_scene_set_shell_tile(vlr_scene* scene, uint32_t material, float metres) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->set_shell_tile(material, metres);
  });
}

vlr_status vlr_scene_set_shell_softness(vlr_scene* scene, uint32_t material, float widths) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->set_shell_softness(material, widths);
  });
}

vlr_status vlr_scene_set_gain(vlr_scene* scene, uint32_t material, const float gain[3]) {
  return guard([&] {
    require(scene, "scene");
    require(gain, "gain");
    scene->scene->set_gain(material, {gain[0], gain[1], gain[2]});
  });
}

vlr_status vlr_scene_hide_backs(vlr_scene* scene, uint32_t material, uint32_t hidden_from) {
  return guard([&] {
    require(scene, "scene");
    require_hidden(hidden_from, kRays);
    scene->scene->set_hidden_backs(material, static_cast<uint8_t>(hidden_from));
  });
}

vlr_status vlr_scene_set_drawn_to(vlr_scene* scene, uint32_t material, int32_t drawn) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->set_drawn_to(material, drawn != 0);
  });
}
