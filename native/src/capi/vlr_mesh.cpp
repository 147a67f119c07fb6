// Meshes of a scene.

#include <span>
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "scene/mesh_file.h"

using namespace velour;
using namespace velour::capi;

namespace {

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
                                              " UV sets in addition to the first.");
  }
  if (desc.color_sets > VLR_MOST_COLOR_SETS) {
    throw Error(Status::invalid_argument, "vlr_mesh_desc.color_sets is " + std::to_string(desc.color_sets) +
                                              "; a mesh has at most " + std::to_string(VLR_MOST_COLOR_SETS) +
                                              " corner color sets.");
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
          .vertex_normals = array_of<Vec3>(desc.vertex_normals, desc.vertex_count),
          .steps = desc.steps,
          .moved_positions = array_of<Vec3>(desc.moved_positions, size_t{desc.steps} * desc.vertex_count),
          .moved_corner_normals = array_of<Vec3>(desc.moved_corner_normals, desc.steps * corners),
          .moved_vertex_normals = array_of<Vec3>(desc.moved_vertex_normals, size_t{desc.steps} * desc.vertex_count)};
}

void initialize(vlr_mesh_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_mesh_desc);
}

/// Builds the meshes in parallel.
std::vector<Mesh> meshes_of(const vlr_mesh_desc* descs, uint64_t count) {
  std::vector<MeshArrays> arrays;
  arrays.reserve(count);
  if (count > 0) require(descs, "descs");
  for (uint64_t i = 0; i < count; ++i) {
    const auto* bytes = reinterpret_cast<const char*>(descs) + i * descs->struct_size;
    const auto* desc = reinterpret_cast<const vlr_mesh_desc*>(bytes);
    if (desc->struct_size != descs->struct_size) {
      throw Error(Status::invalid_argument, "vlr_mesh_desc.struct_size must be the same for all meshes.");
    }
    arrays.push_back(arrays_of(read_options(desc, initialize, "vlr_mesh_desc")));
  }
  return build_meshes(arrays);
}

}  // namespace

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
    scene->scene->add_moving_instance(mesh, affines_from(object_to_world, scene->steps), {materials, materials + count},
                                      std::move(maps), scene->hidden_from, scene->terminator);
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
      const float* const matrices = object_to_world + 12 * scene->steps * i;
      scene->scene->add_moving_instance(meshes[i], affines_from(matrices, scene->steps), {materials, materials + count},
                                        {}, scene->hidden_from, scene->terminator);
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

vlr_status vlr_scene_move_instances(vlr_scene* scene, uint32_t steps) {
  return guard([&] {
    require(scene, "scene");
    if (steps < 1 || steps > kMaxMotionSteps) {
      throw Error(Status::invalid_argument, "Instances move in " + std::to_string(steps) +
                                                " steps; the number must be 1 to " + std::to_string(kMaxMotionSteps) +
                                                ".");
    }
    scene->steps = steps;
  });
}

vlr_status vlr_scene_clear_instances(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->clear_instances();
  });
}
