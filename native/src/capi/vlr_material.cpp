// Materials of a scene and their settings.
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "material/principled/principled_material.h"

using namespace velour;
using namespace velour::capi;

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
    *material = scene->scene->add_material(
        surface_of(kept(measurement->measurement), proposal ? kept(proposal->model) : nullptr, neighbors));
  });
}

vlr_status vlr_scene_add_btf_material(vlr_scene* scene, const vlr_btf* btf, uint64_t most_bytes, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(btf, "btf");
    require(material, "material");
    *material = scene->scene->add_material(surface_of(*kept(btf->btf), most_bytes));
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
  desc->surface_correction = VLR_RELIEF_AS_IT_IS;
  desc->formula = static_cast<int32_t>(defaults.formula);
  desc->lobe = static_cast<int32_t>(defaults.lobe);
  desc->alpha = 1.0f;
  for (int i = 0; i < 3; ++i) desc->specular_tint[i] = defaults.specular_tint[i];
  desc->coat = defaults.coat;
  desc->coat_roughness = defaults.coat_roughness;
  desc->coat_index = defaults.coat_index;
  for (int i = 0; i < 3; ++i) desc->coat_tint[i] = defaults.coat_tint[i];
  desc->coat_lobe = static_cast<int32_t>(defaults.coat_lobe);
  desc->index = defaults.index;
  desc->sheen_roughness = defaults.sheen_roughness;
  for (int i = 0; i < 3; ++i) desc->sheen_tint[i] = defaults.sheen_tint[i];
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
