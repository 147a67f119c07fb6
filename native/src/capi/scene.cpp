#include "scene/scene.h"

#include <span>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports.h"
#include "capi/texture_maps.h"
#include "fit/scattered_fit.h"
#include "material/holed_btf_material.h"
#include "material/measured_btf_material.h"
#include "material/principled_lobes.h"
#include "material/through_material.h"
#include "model/model_material.h"
#include "scene/build_meshes.h"
#include "scene/mesh_file.h"

using namespace velour;
using namespace velour::capi;

namespace {

constexpr uint32_t kRays = VLR_HIDDEN_FROM_CAMERA | VLR_HIDDEN_FROM_BOUNCES | VLR_HIDDEN_FROM_SHADOWS;

void require_hidden(uint32_t hidden_from, uint32_t known) {
  if ((hidden_from & ~known) == 0) return;
  throw Error(Status::invalid_argument,
              "hidden_from is " + std::to_string(hidden_from) + ", which has bits that are no VLR_HIDDEN value.");
}

Rgb color_from(const float* c) { return {c[0], c[1], c[2]}; }

Mat3 matrix_from_rows(const float* m) {
  if (!m) return Mat3(1.0f);
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

Affine affine_from(const float* m) {
  Affine map;
  std::copy(m, m + 12, map.m);
  return map;
}

template <typename T>
std::span<const T> array_of(const void* first, size_t count) {
  return first ? std::span<const T>(static_cast<const T*>(first), count) : std::span<const T>();
}

MeshArrays arrays_of(const vlr_mesh_desc& desc) {
  require(desc.positions, "vlr_mesh_desc.positions");
  require(desc.triangles, "vlr_mesh_desc.triangles");
  if (desc.more_uv_sets >= VLR_MOST_UV_SETS) {
    throw Error(Status::invalid_argument, "vlr_mesh_desc.more_uv_sets is " + std::to_string(desc.more_uv_sets) +
                                              "; a mesh has at most " + std::to_string(VLR_MOST_UV_SETS - 1) +
                                              " sets of texture coordinates beside the first.");
  }
  if (desc.color_sets > VLR_MOST_COLOR_SETS) {
    throw Error(Status::invalid_argument, "vlr_mesh_desc.color_sets is " + std::to_string(desc.color_sets) +
                                              "; a mesh has at most " + std::to_string(VLR_MOST_COLOR_SETS) +
                                              " sets of corner colours.");
  }
  const size_t triangles = desc.triangle_count, corners = desc.corner_vertices ? desc.corner_count : 3 * triangles;
  return {.positions = array_of<Vec3>(desc.positions, desc.vertex_count),
          .triangles = array_of<glm::uvec3>(desc.triangles, triangles),
          .corner_normals = array_of<Vec3>(desc.corner_normals, corners),
          .corner_uvs = array_of<Vec2>(desc.corner_uvs, corners),
          .more_uvs = array_of<Vec2>(desc.more_uvs, corners * desc.more_uv_sets),
          .relief_uvs = array_of<Vec2>(desc.relief_uvs, corners),
          .corner_colors = array_of<Rgb>(desc.corner_colors, corners * desc.color_sets),
          .material_slots = array_of<uint32_t>(desc.material_slots, triangles),
          .smooth = array_of<uint8_t>(desc.smooth, triangles),
          .corner_vertices = array_of<uint32_t>(desc.corner_vertices, corners),
          .vertex_normals = array_of<Vec3>(desc.vertex_normals, desc.vertex_count)};
}

void initialize(vlr_mesh_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_mesh_desc);
}

/// Built side by side.
std::vector<Mesh> meshes_of(const vlr_mesh_desc* descs, uint64_t count) {
  std::vector<MeshArrays> arrays;
  arrays.reserve(count);
  if (count > 0) require(descs, "descs");
  for (uint64_t i = 0; i < count; ++i) {
    const auto* bytes = reinterpret_cast<const char*>(descs) + i * descs->struct_size;
    const auto* desc = reinterpret_cast<const vlr_mesh_desc*>(bytes);
    if (desc->struct_size != descs->struct_size) {
      throw Error(Status::invalid_argument, "vlr_mesh_desc.struct_size is not the same of all meshes.");
    }
    arrays.push_back(arrays_of(read_options(desc, initialize, "vlr_mesh_desc")));
  }
  return build_meshes(arrays);
}

/// Lobes that draw samples for a raw measurement: speed depends on how well they fit, the picture does not, so a coarse
/// fit of all data serves.
std::shared_ptr<const Model> coarse_proposal(const Measurement& measurement) {
  FitOptions options;
  options.max_lobes = 8;
  options.tolerance = 0.05;
  options.all_data = true;
  Progress unwatched;
  return std::make_shared<const Model>(fit_scattered(measurement, options, unwatched));
}

SurfaceMaterial brushed_if_anisotropic(SurfaceMaterial surface) {
  surface.brushed = !surface.material->isotropic() && !surface.material->varies();
  return surface;
}

SurfaceMaterial surface_of(const std::shared_ptr<const Model>& model, uint32_t neighbors) {
  SurfaceMaterial surface{.material = make_material(model, static_cast<int>(neighbors))};
  if (!model->shell) return brushed_if_anisotropic(std::move(surface));
  surface.shell = std::make_shared<const ShellField>(model->shell->volume);
  surface.shell_shaded = !is_btf(*model);
  if (surface.holed()) surface.material = std::make_shared<const HoledBtfMaterial>(surface.material);
  return surface;
}

/// A BTF itself; of two sides, with light that comes through.
std::shared_ptr<const Material> make_lit_from_both(const std::shared_ptr<const BtfTable>& table) {
  auto reflecting = make_measured_btf_material(table);
  if (!table->between.knows_through()) return reflecting;
  return std::make_shared<const ThroughMaterial>(std::move(reflecting),
                                                 make_measured_btf_material(table, BtfLight::other_side));
}

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

Aperture aperture_from(const vlr_camera_desc& desc) {
  constexpr uint32_t kMostBlades = 1024;
  if (!(desc.aperture >= 0.0f) || !(desc.focus > 0.0f) || !(desc.aperture_ratio > 0.0f) || desc.blades > kMostBlades) {
    throw Error(Status::invalid_argument,
                "vlr_camera_desc: aperture must not be negative, focus and aperture_ratio must be positive and blades "
                "at most 1024.");
  }
  return {.radius = desc.aperture,
          .focus = desc.focus,
          .blades = static_cast<int>(desc.blades),
          .rotation = desc.blade_rotation,
          .ratio = desc.aperture_ratio};
}

}  // namespace

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

vlr_status vlr_scene_add_mesh(vlr_scene* scene, const vlr_mesh_desc* desc, uint32_t* mesh, uint32_t* dropped) {
  return guard([&] {
    require(scene, "scene");
    require(desc, "desc");
    require(mesh, "mesh");
    Mesh added(arrays_of(read_options(desc, initialize, "vlr_mesh_desc")));
    if (dropped) *dropped = added.dropped();
    *mesh = scene->scene->add_mesh(std::move(added));
  });
}

vlr_status vlr_scene_add_meshes(vlr_scene* scene, const vlr_mesh_desc* descs, uint64_t count, uint32_t* first,
                                uint32_t* dropped) {
  return guard([&] {
    require(scene, "scene");
    require(first, "first");
    std::vector<Mesh> added = meshes_of(descs, count);
    for (uint64_t i = 0; dropped && i < count; ++i) dropped[i] = added[i].dropped();
    *first = static_cast<uint32_t>(scene->scene->meshes().size());
    for (Mesh& mesh : added) scene->scene->add_mesh(std::move(mesh));
  });
}

vlr_status vlr_scene_load_mesh(vlr_scene* scene, const char* path, uint32_t* mesh) {
  return guard([&] {
    require(scene, "scene");
    require(path, "path");
    require(mesh, "mesh");
    *mesh = scene->scene->add_mesh(read_mesh(path));
  });
}

vlr_status vlr_scene_remove_mesh(vlr_scene* scene, uint32_t mesh) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->remove_mesh(mesh);
  });
}

vlr_status vlr_scene_replace_material(vlr_scene* scene, uint32_t material) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->replace_material(material);
  });
}

vlr_status vlr_scene_clear_instances(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->clear_instances();
  });
}

vlr_status vlr_scene_clear_lights(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->clear_lights();
  });
}

vlr_status vlr_scene_add_model_material(vlr_scene* scene, const vlr_model* model, uint32_t neighbors,
                                        uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(model, "model");
    require(material, "material");
    *material = scene->scene->add_material(surface_of(model->model, neighbors));
  });
}

vlr_status vlr_scene_set_model_material(vlr_scene* scene, uint32_t material, const vlr_model* model,
                                        uint32_t neighbors) {
  return guard([&] {
    require(scene, "scene");
    require(model, "model");
    scene->scene->set_material(material, surface_of(model->model, neighbors));
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

vlr_status vlr_scene_add_measurement_material(vlr_scene* scene, const vlr_measurement* measurement,
                                              const vlr_model* proposal, uint32_t neighbors, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(measurement, "measurement");
    require(material, "material");
    const auto model = proposal ? proposal->model : coarse_proposal(*measurement->measurement);
    *material = scene->scene->add_material(brushed_if_anisotropic(
        {.material = make_measured_material(measurement->measurement, model, static_cast<int>(neighbors))}));
  });
}

vlr_status vlr_scene_add_btf_material(vlr_scene* scene, const vlr_btf* btf, uint64_t most_bytes, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(btf, "btf");
    require(material, "material");
    auto table = read_btf_table(*btf->btf, most_bytes != 0 ? most_bytes : kUsualTableBytes);
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
  desc->alpha = 1.0f;
}

vlr_status vlr_scene_add_principled_material(vlr_scene* scene, const vlr_principled_desc* desc, uint32_t* material) {
  return vlr_scene_add_textured_material(scene, desc, nullptr, material);
}

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
                               scene->hidden_from);
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
                                 scene->hidden_from);
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
      throw Error(Status::invalid_argument, "A world image of " + std::to_string(width) + " x " +
                                                std::to_string(height) + " pixels and " + std::to_string(channels) +
                                                " channels cannot be used; sides go to 65536, channels to 4.");
    }
    const size_t values = size_t{width} * height * channels;
    scene->scene->set_environment(
        Environment::image({static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels),
                            std::span<const float>(pixels, values)},
                           strength, matrix_from_rows(world_to_image)));
  });
}

vlr_status vlr_scene_load_world(vlr_scene* scene, const char* path, float strength, const float* world_to_image) {
  return guard([&] {
    require(scene, "scene");
    require(path, "path");
    scene->scene->set_environment(Environment::load(path, strength, matrix_from_rows(world_to_image)));
  });
}

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
