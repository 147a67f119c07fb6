// Lights and the environment.
#include <algorithm>
#include <span>

#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"

using namespace velour;
using namespace velour::capi;

namespace {

Light converted(const vlr_light_desc& desc) {
  if (desc.type < VLR_LIGHT_SUN || desc.type > VLR_LIGHT_SPOT) {
    throw Error(Status::invalid_argument,
                "vlr_light_desc.type is " + std::to_string(desc.type) + ", not a VLR_LIGHT value.");
  }
  return {.type = static_cast<Light::Type>(desc.type),
          .color = color_from(desc.color),
          .light_to_world = affine_from(desc.light_to_world),
          .size = {desc.size[0], desc.size[1]},
          .angle = desc.angle,
          .blend = desc.blend,
          .cone_scale = {desc.cone_scale[0], desc.cone_scale[1]},
          .cosine = desc.cosine != 0,
          .spread = desc.spread,
          .sphere = desc.sphere != 0,
          .casts_shadow = desc.casts_shadow != 0};
}

}  // namespace

void vlr_light_desc_init(vlr_light_desc* desc) {
  const Light defaults;
  *desc = {};
  desc->struct_size = sizeof(vlr_light_desc);
  desc->type = static_cast<int32_t>(defaults.type);
  for (int i = 0; i < 3; ++i) desc->color[i] = defaults.color[i];
  std::copy(std::begin(defaults.light_to_world.m), std::end(defaults.light_to_world.m), desc->light_to_world);
  desc->size[0] = defaults.size.x;
  desc->size[1] = defaults.size.y;
  desc->angle = defaults.angle;
  desc->casts_shadow = defaults.casts_shadow ? 1 : 0;
  desc->blend = defaults.blend;
  desc->cosine = defaults.cosine ? 1 : 0;
  for (int i = 0; i < 2; ++i) desc->cone_scale[i] = defaults.cone_scale[i];
  desc->spread = defaults.spread;
  desc->sphere = defaults.sphere ? 1 : 0;
}

vlr_status vlr_scene_add_light(vlr_scene* scene, const vlr_light_desc* desc) {
  return guard([&] {
    require(scene, "scene");
    require(desc, "desc");
    scene->scene->add_light(converted(read_options(desc, vlr_light_desc_init, "vlr_light_desc")));
  });
}

vlr_status vlr_scene_clear_lights(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->clear_lights();
  });
}

vlr_status vlr_scene_set_world_color(vlr_scene* scene, const float* color) {
  return guard([&] {
    require(scene, "scene");
    require(color, "color");
    scene->scene->set_environment(Environment::constant(color_from(color)));
  });
}

vlr_status vlr_scene_set_world_pixels(vlr_scene* scene, uint32_t width, uint32_t height, uint32_t channels,
                                      const float* pixels, float strength, const float* world_to_image) {
  return guard([&] {
    require(scene, "scene");
    require(pixels, "pixels");
    constexpr uint32_t kLargest = 65536;
    if (width > kLargest || height > kLargest || channels > 4) {
      throw Error(Status::invalid_argument,
                  "The environment image has " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels and " + std::to_string(channels) +
                      " channels; at most 65536 pixels along each side and 4 channels are supported.");
    }
    const size_t values = size_t{width} * height * channels;
    scene->scene->set_environment(
        Environment::image({static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels),
                            std::span<const float>(pixels, values)},
                           strength, matrix_from_rows(world_to_image)));
  });
}

vlr_status vlr_scene_place_world(vlr_scene* scene, float strength, const float* world_to_image) {
  return guard([&] {
    require(scene, "scene");
    const Environment& environment = scene->scene->environment();
    scene->scene->set_environment(environment.placed(strength, matrix_from_rows(world_to_image)));
  });
}

vlr_status vlr_scene_load_world(vlr_scene* scene, const char* path, float strength, const float* world_to_image) {
  return vlr_scene_load_world_picture(scene, path, nullptr, strength, world_to_image);
}

vlr_status vlr_scene_load_world_picture(vlr_scene* scene, const char* path, const vlr_picture_options* options,
                                        float strength, const float* world_to_image) {
  return guard([&] {
    require(scene, "scene");
    require(path, "path");
    scene->scene->set_environment(
        Environment::load(path, converted(options), strength, matrix_from_rows(world_to_image)));
  });
}
