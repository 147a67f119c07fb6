#include "tile/tile.h"

#include <algorithm>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/tile_reports.h"

using namespace velour;
using namespace velour::capi;

namespace {

std::optional<double> given(double value) { return value < 0 ? std::nullopt : std::optional(value); }

std::optional<int> given(uint32_t value) {
  constexpr uint32_t kLargest = 1u << 20;  // beyond the limit of any tile, and within int
  return value == 0 ? std::nullopt : std::optional(static_cast<int>(std::min(value, kLargest)));
}

TileOptions converted(const vlr_tile_options& options) {
  require(options.kind, "vlr_tile_options.kind");
  return {.kind = options.kind,
          .size = given(options.size),
          .thickness = given(options.thickness),
          .gap = given(options.gap),
          .irregularity = given(options.irregularity),
          .count = given(options.count),
          .resolution = given(options.resolution),
          .seed = options.seed};
}

vlr_mesh_desc described(const TileMesh& mesh) {
  vlr_mesh_desc desc = {};
  desc.vertex_count = static_cast<uint32_t>(mesh.positions.size());
  desc.triangle_count = static_cast<uint32_t>(mesh.triangles.size());
  desc.positions = &mesh.positions.front().x;
  desc.triangles = &mesh.triangles.front().x;
  desc.corner_normals = &mesh.corner_normals.front().x;
  desc.corner_uvs = &mesh.corner_uvs.front().x;
  desc.material_slots = mesh.slots.data();
  return desc;
}

vlr_principled_desc described(const PrincipledParameters& parameters) {
  vlr_principled_desc desc;
  vlr_principled_desc_init(&desc);
  for (int i = 0; i < 3; ++i) desc.base_color[i] = parameters.base_color[i];
  desc.metallic = parameters.metallic;
  desc.roughness = parameters.roughness;
  desc.specular = parameters.specular;
  return desc;
}

}  // namespace

void vlr_tile_options_init(vlr_tile_options* options) {
  static const std::string kKind = TileOptions().kind;
  *options = {};
  options->struct_size = sizeof(vlr_tile_options);
  options->kind = kKind.c_str();
  options->size = options->thickness = options->gap = options->irregularity = -1;
}

vlr_status vlr_tile_kinds_json(const char** json) {
  return guard([&] {
    require(json, "json");
    static const std::string kText = tile_kinds_json();
    *json = kText.c_str();
  });
}

vlr_status vlr_tile_create(const vlr_tile_options* options, vlr_tile** out) {
  return guard([&] {
    require(out, "out");
    *out = new vlr_tile{make_tile(converted(read_options(options, vlr_tile_options_init, "vlr_tile_options"))), {}};
  });
}

void vlr_tile_free(vlr_tile* tile) { delete tile; }

vlr_status vlr_tile_desc(const vlr_tile* tile, vlr_mesh_desc* desc) {
  return guard([&] {
    require(tile, "tile");
    write_struct(described(tile->tile.parts.mesh), desc, "vlr_mesh_desc");
  });
}

vlr_status vlr_tile_material(const vlr_tile* tile, uint32_t slot, vlr_principled_desc* material) {
  return guard([&] {
    require(tile, "tile");
    const auto& materials = tile->tile.parts.materials;
    if (slot >= materials.size()) {
      throw Error(Status::invalid_argument, "The tile " + tile->tile.kind + " has " + std::to_string(materials.size()) +
                                                " material slots; slot " + std::to_string(slot) + " does not exist.");
    }
    write_struct(described(materials[slot].parameters), material, "vlr_principled_desc");
  });
}

vlr_status vlr_tile_info_json(vlr_tile* tile, const char** json) {
  return guard([&] {
    require(tile, "tile");
    require(json, "json");
    tile->info = tile_json(tile->tile);
    *json = tile->info.c_str();
  });
}
