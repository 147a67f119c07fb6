// The camera of a scene.
#include <algorithm>

#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"

using namespace velour;
using namespace velour::capi;

namespace {

Aperture aperture_from(const vlr_camera_desc& desc) {
  constexpr uint32_t kMostBlades = 1024;
  if (!(desc.aperture >= 0.0f) || !(desc.focus > 0.0f) || !(desc.aperture_ratio > 0.0f) || desc.blades > kMostBlades) {
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
