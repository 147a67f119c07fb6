#include "capi/tile_reports.h"

#include <algorithm>

#include "capi/json_text.h"

namespace velour::capi {
namespace {

Json material_json(const TileMaterial& material) {
  const PrincipledParameters& p = material.parameters;
  return {{"name", material.name},
          {"base_color", colour(p.base_color)},
          {"metallic", p.metallic},
          {"roughness", p.roughness},
          {"specular", p.specular}};
}

Json shape_json(const TileShape& shape) {
  return {{"size", shape.size},           {"count", shape.count}, {"resolution", shape.resolution},
          {"thickness", shape.thickness}, {"gap", shape.gap},     {"irregularity", shape.irregularity}};
}

Json heights_json(const TileMesh& mesh) {
  const auto [lowest, highest] = std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                                                     [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  return {lowest->z, highest->z};
}

}  // namespace

std::string tile_json(const Tile& tile) {
  const TileMesh& mesh = tile.parts.mesh;
  Json shape = shape_json(tile.shape), materials = Json::array();
  shape["seed"] = tile.shape.seed;
  for (const TileMaterial& material : tile.parts.materials) materials.push_back(material_json(material));
  return text({{"kind", tile.kind},
               {"period", {tile.period.x, tile.period.y}},
               {"heights", heights_json(mesh)},
               {"open", tile.parts.open},
               {"open_area", or_null(tile.parts.open_area)},
               {"vertices", mesh.positions.size()},
               {"triangles", mesh.triangles.size()},
               {"shape", shape},
               {"materials", materials}});
}

std::string tile_kinds_json() {
  Json kinds = Json::array();
  for (const TileKind& kind : tile_kinds()) {
    Json defaults = shape_json(kind.defaults);
    if (kind.least_gap == 0) defaults.erase("gap");
    if (!kind.has_irregularity) defaults.erase("irregularity");
    kinds.push_back({{"name", kind.name}, {"summary", kind.summary}, {"defaults", defaults}});
  }
  return text({{"kinds", kinds}});
}

}  // namespace velour::capi
