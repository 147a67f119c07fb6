// Instances of a scene: meshes with their transforms and materials.
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/texture_maps.h"

using namespace velour;
using namespace velour::capi;

vlr_status vlr_scene_add_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                  const uint32_t* materials, uint32_t count) {
  return vlr_scene_add_placed_instance(scene, mesh, object_to_world, materials, nullptr, count);
}

vlr_status vlr_scene_add_placed_instance(vlr_scene* scene, uint32_t mesh, const float* object_to_world,
                                         const uint32_t* materials, const float* placements, uint32_t count) {
  return guard([&] {
    require(scene, "scene");
    require(object_to_world, "object_to_world");
    require(materials, "materials");
    std::vector<TextureMap> maps;
    for (uint32_t i = 0; placements != nullptr && i < count; ++i) maps.push_back(map_from(placements + 6 * i));
    scene->scene->add_instance(mesh, affine_from(object_to_world), {materials, materials + count}, std::move(maps),
                               scene->hidden_from, scene->terminator);
  });
}

vlr_status vlr_scene_add_instances(vlr_scene* scene, const uint32_t* meshes, const float* object_to_world,
                                   uint64_t instances, const uint32_t* materials, uint32_t count) {
  return guard([&] {
    require(scene, "scene");
    require(meshes, "meshes");
    require(object_to_world, "object_to_world");
    require(materials, "materials");
    for (uint64_t i = 0; i < instances; ++i) {
      scene->scene->add_instance(meshes[i], affine_from(object_to_world + 12 * i), {materials, materials + count}, {},
                                 scene->hidden_from, scene->terminator);
    }
  });
}

vlr_status vlr_scene_hide_instances(vlr_scene* scene, uint32_t hidden_from) {
  return guard([&] {
    require(scene, "scene");
    require_hidden(hidden_from, kRays | VLR_HOLDOUT);
    scene->hidden_from = static_cast<uint8_t>(hidden_from);
  });
}

vlr_status vlr_scene_soften_terminator(vlr_scene* scene, float offset) {
  return guard([&] {
    require(scene, "scene");
    if (!(offset >= 0.0f && offset <= 1.0f)) {
      throw Error(Status::invalid_argument,
                  "The shadow terminator offset is " + std::to_string(offset) + "; it must be 0 to 1.");
    }
    scene->terminator = offset;
  });
}

vlr_status vlr_scene_clear_instances(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->clear_instances();
  });
}
