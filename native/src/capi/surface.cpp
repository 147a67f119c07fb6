#include "capi/surfaces.h"

#include "capi/texture_maps.h"
#include "material/principled_material.h"

namespace velour::capi {

namespace {

[[noreturn]] void refuse_kind(const char* field, const char* needed) {
  throw Error(Status::invalid_argument, std::string(field) + " requires a texture of " + needed + ".");
}

static_assert(VLR_MOST_UV_SETS == SurfaceSite::kMostSets);

size_t known_set(uint32_t set, const char* field) {
  if (set < SurfaceSite::kMostSets) return set;
  throw Error(Status::invalid_argument, std::string(field) + " uses UV set " + std::to_string(set) +
                                            "; a material has UV sets 0 to " +
                                            std::to_string(SurfaceSite::kMostSets - 1) + ".");
}

}  // namespace

TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field) {
  if (texture == nullptr) return {};
  if (texture->corner_colors) return TextureSlot<Rgb>::colors_of_corners(*texture->corner_colors);
  if (!texture->color) refuse_kind(field, "colors (channel -1)");
  return {texture->color, map_from(map), known_set(set, field)};
}

TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field) {
  if (texture == nullptr) return {};
  if (texture->corner_colors) return TextureSlot<float>::colors_of_corners(*texture->corner_colors);
  if (!texture->number) refuse_kind(field, "numbers (channel 0 or higher)");
  return {texture->number, map_from(map), known_set(set, field)};
}

MeshSets sets_of(const PrincipledTextures& t) {
  MeshSets sets;
  sets.add(t.base_color);
  sets.add(t.metallic);
  sets.add(t.roughness);
  sets.add(t.alpha);
  return sets;
}

PrincipledTextures converted_textures(const vlr_principled_textures& t) {
  return {color_slot(t.base_color, t.base_color_map, t.base_color_set, "vlr_principled_textures.base_color"),
          number_slot(t.metallic, t.metallic_map, t.metallic_set, "vlr_principled_textures.metallic"),
          number_slot(t.roughness, t.roughness_map, t.roughness_set, "vlr_principled_textures.roughness"),
          number_slot(t.alpha, t.alpha_map, t.alpha_set, "vlr_principled_textures.alpha")};
}

static_assert(VLR_PRINCIPLED_DISNEY == static_cast<int>(PrincipledFormula::disney));
static_assert(VLR_GGX_SINGLE == static_cast<int>(GgxLobe::single));
static_assert(VLR_GGX_SEPARABLE == static_cast<int>(GgxLobe::separable));

GgxLobe lobe_of(const vlr_principled_desc& desc) {
  require_choice(desc.lobe, VLR_GGX_SEPARABLE, "vlr_principled_desc.lobe");
  return static_cast<GgxLobe>(desc.lobe);
}

PrincipledParameters parameters_of(const vlr_principled_desc& desc) {
  require_choice(desc.formula, VLR_PRINCIPLED_DISNEY, "vlr_principled_desc.formula");
  require_choice(desc.coat_lobe, VLR_GGX_SINGLE, "vlr_principled_desc.coat_lobe");
  const auto color = [](const float* c) { return Rgb(c[0], c[1], c[2]); };
  return {.base_color = color(desc.base_color),
          .metallic = desc.metallic,
          .roughness = desc.roughness,
          .specular = desc.specular,
          .specular_tint = color(desc.specular_tint),
          .coat = desc.coat,
          .coat_roughness = desc.coat_roughness,
          .coat_index = desc.coat_index,
          .coat_tint = color(desc.coat_tint),
          .formula = static_cast<PrincipledFormula>(desc.formula),
          .lobe = lobe_of(desc),
          .coat_lobe = static_cast<GgxLobe>(desc.coat_lobe)};
}

std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures) {
  return make_principled_material(parameters_of(desc), textures, desc.alpha);
}

}  // namespace velour::capi

using namespace velour;
using namespace velour::capi;

void vlr_principled_textures_init(vlr_principled_textures* textures) {
  *textures = {};
  textures->struct_size = sizeof(vlr_principled_textures);
  for (float* map : {textures->base_color_map, textures->metallic_map, textures->roughness_map, textures->alpha_map}) {
    map[0] = map[4] = 1.0f;
  }
}

vlr_status vlr_scene_add_textured_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                           const vlr_principled_textures* textures, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(material, "material");
    const auto given = read_options(desc, vlr_principled_desc_init, "vlr_principled_desc");
    const auto pictures =
        converted_textures(read_options(textures, vlr_principled_textures_init, "vlr_principled_textures"));
    *material = scene->scene->add_material({.material = material_of(given, pictures),
                                            .emission = {given.emission[0], given.emission[1], given.emission[2]},
                                            .rec709_colors = false,
                                            .uv_sets = sets_of(pictures).uvs,
                                            .color_sets = sets_of(pictures).colors});
  });
}
