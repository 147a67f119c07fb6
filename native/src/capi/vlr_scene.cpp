
#include <algorithm>
#include <span>
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "scene/scene.h"

using namespace velour;
using namespace velour::capi;

vlr_status vlr_scene_create(vlr_scene** out) {
  return guard([&] {
    require(out, "out");
    embree_self_test();
    *out = new vlr_scene{std::make_shared<Scene>(), {}, 0};
  });
}

void vlr_scene_free(vlr_scene* scene) { delete scene; }

vlr_status vlr_scene_set_working_space(vlr_scene* scene, const float* rec709_to_working) {
  return guard([&] {
    require(scene, "scene");
    require(rec709_to_working, "rec709_to_working");
    scene->scene->set_working_space(matrix_from_rows(rec709_to_working));
  });
}

vlr_status vlr_scene_stay(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->stay();
  });
}

vlr_status vlr_scene_commit(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->commit();
  });
}

vlr_status vlr_scene_info_json(vlr_scene* scene, const char** json) {
  return guard([&] {
    require(scene, "scene");
    require(json, "json");
    scene->info = scene_json(*scene->scene);
    *json = scene->info.c_str();
  });
}

namespace {

Aperture aperture_from(const vlr_camera_desc& desc) {
  constexpr uint32_t kMaxBlades = 1024;
  if (!(desc.aperture >= 0.0f) || !(desc.focus > 0.0f) || !(desc.aperture_ratio > 0.0f) || desc.blades > kMaxBlades) {
    throw Error(Status::invalid_argument,
                "vlr_camera_desc: aperture must be at least 0, focus and aperture_ratio must be positive, and blades "
                "must be at most 1024.");
  }
  return {.radius = desc.aperture,
          .focus = desc.focus,
          .blades = static_cast<int>(desc.blades),
          .rotation = desc.blade_rotation,
          .ratio = desc.aperture_ratio};
}

void add_motion(const vlr_camera_desc& desc, Camera& camera) {
  if (!desc.motion && !desc.motion_window) return;
  if (desc.steps < 2 || desc.steps > kMaxMotionSteps) {
    throw Error(Status::invalid_argument, "vlr_camera_desc.steps is " + std::to_string(desc.steps) +
                                              "; the camera moves in 2 to " + std::to_string(kMaxMotionSteps) +
                                              " steps.");
  }
  if (desc.motion) {
    const std::vector<Affine> keys = affines_from(desc.motion, desc.steps);
    camera.steps = motion_steps(keys);
    camera.camera_to_world = camera.steps.empty() ? keys[0] : interpolated(camera.steps, kMiddleTime);
  }
  for (const float* w = desc.motion_window; w && w < desc.motion_window + 4 * desc.steps; w += 4) {
    camera.windows.push_back({w[0], w[1], w[2], w[3]});
  }
  if (camera.windows.empty()) return;
  const std::array<float, 4> middle = camera.window_at(kMiddleTime);
  std::copy(middle.begin(), middle.end(), camera.window);
}

}  // namespace

void vlr_camera_desc_init(vlr_camera_desc* desc) {
  const Camera defaults;
  *desc = {};
  desc->struct_size = sizeof(vlr_camera_desc);
  desc->type = static_cast<int32_t>(defaults.type);
  std::copy(std::begin(defaults.camera_to_world.m), std::end(defaults.camera_to_world.m), desc->camera_to_world);
  std::copy(std::begin(defaults.window), std::end(defaults.window), desc->window);
  desc->clip_start = defaults.clip_start;
  desc->clip_end = defaults.clip_end;
  desc->aperture = defaults.aperture.radius;
  desc->focus = defaults.aperture.focus;
  desc->blades = static_cast<uint32_t>(defaults.aperture.blades);
  desc->blade_rotation = defaults.aperture.rotation;
  desc->aperture_ratio = defaults.aperture.ratio;
}

vlr_status vlr_scene_set_camera(vlr_scene* scene, const vlr_camera_desc* desc) {
  return guard([&] {
    require(scene, "scene");
    require(desc, "desc");
    const auto given = read_options(desc, vlr_camera_desc_init, "vlr_camera_desc");
    if (given.type != VLR_CAMERA_PERSPECTIVE && given.type != VLR_CAMERA_ORTHOGRAPHIC) {
      throw Error(Status::invalid_argument,
                  "vlr_camera_desc.type is " + std::to_string(given.type) + ", not a VLR_CAMERA value.");
    }
    Camera camera{.type = static_cast<Camera::Type>(given.type),
                  .camera_to_world = affine_from(given.camera_to_world),
                  .clip_start = given.clip_start,
                  .clip_end = given.clip_end,
                  .aperture = aperture_from(given)};
    std::copy(std::begin(given.window), std::end(given.window), camera.window);
    if (given.shutter) {
      camera.shutter.emplace(std::vector<float>(given.shutter, given.shutter + given.shutter_count));
    }
    add_motion(given, camera);
    scene->scene->set_camera(camera);
  });
}

vlr_status vlr_scene_look_at(vlr_scene* scene, const float* eye, const float* target, float fov, float aspect) {
  return guard([&] {
    require(scene, "scene");
    require(eye, "eye");
    require(target, "target");
    const Vec3 up(0, 0, 1);
    scene->scene->set_camera(
        Camera::look_at({eye[0], eye[1], eye[2]}, {target[0], target[1], target[2]}, up, fov, aspect));
  });
}

vlr_status vlr_scene_frame_camera(vlr_scene* scene, float aspect, uint32_t up_axis) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->frame_camera(aspect, static_cast<int>(up_axis));
  });
}

namespace {

Light converted(const vlr_light_desc& desc) {
  if (desc.type < VLR_LIGHT_SUN || desc.type > VLR_LIGHT_SPOT) {
    throw Error(Status::invalid_argument,
                "vlr_light_desc.type is " + std::to_string(desc.type) + ", not a VLR_LIGHT value.");
  }
  require_hidden(desc.hidden_from, kContinuedRays);
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
          .casts_shadow = desc.casts_shadow != 0,
          .is_mirrored = desc.mirrored != 0,
          .hidden_from = static_cast<uint8_t>(desc.hidden_from)};
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
  desc->mirrored = defaults.is_mirrored ? 1 : 0;
  desc->hidden_from = defaults.hidden_from;
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

vlr_status vlr_scene_hide_world(vlr_scene* scene, uint32_t hidden_from) {
  return guard([&] {
    require(scene, "scene");
    require_hidden(hidden_from, kContinuedRays);
    scene->scene->hide_environment(static_cast<uint8_t>(hidden_from));
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
    constexpr uint32_t kLargest = 65535;
    if (width > kLargest || height > kLargest || channels > 4) {
      throw Error(Status::invalid_argument,
                  "The environment image has " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels and " + std::to_string(channels) +
                      " channels; at most 65535 pixels along each side and 4 channels are supported.");
    }
    const size_t values = size_t{width} * height * channels;
    scene->scene->set_environment(
        Environment::image({static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels),
                            std::span<const float>(pixels, values)},
                           strength, matrix_from_rows(world_to_image)));
  });
}

vlr_status vlr_scene_set_world_program(vlr_scene* scene, const vlr_program* program, uint32_t output, uint32_t width,
                                       uint32_t height) {
  return guard([&] {
    require(scene, "scene");
    require(program, "program");
    constexpr uint32_t kLargest = 16384;
    if (width < 1 || height < 1 || width > kLargest || height > kLargest) {
      throw Error(Status::invalid_argument, "The world's image cannot have " + std::to_string(width) + " x " +
                                                std::to_string(height) +
                                                " texels; 1 to 16384 along each side are supported.");
    }
    scene->scene->set_world(WorldProgram(program->program, output), static_cast<int>(width), static_cast<int>(height));
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
