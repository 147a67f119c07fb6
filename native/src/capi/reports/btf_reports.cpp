#include "capi/reports/reports.h"

#include <algorithm>
#include "model/file/record_json.h"

namespace velour::capi {

namespace {

double largest_theta(const std::vector<PolarAngles>& directions) {
  double largest = 0;
  for (const PolarAngles& d : directions) largest = std::max(largest, d.theta);
  return largest;
}

Json shell_json(const std::optional<Shell>& shell) {
  if (!shell) return nullptr;
  return {{"thickness", shell->thickness}, {"reference_height", shell->reference_height}};
}

Json entries_json(const CountedPairs& counted) {
  return {{"pairs", counted.pairs},
          {"values", counted.counts.values},
          {"not_finite", counted.counts.not_finite},
          {"negative", counted.counts.negative}};
}

}  // namespace

std::string btf_json(const BtfMeasurement& btf) {
  const PairLayout& layout = btf.layout();
  Json json = source_json("btf", btf.provenance());
  json.update(
      Json{{"raw_bytes", btf.raw_bytes()},
           {"texels", {btf.grid().width, btf.grid().height}},
           {"views", layout.views().size()},
           {"lights", layout.lights().size()},
           {"pairs", layout.pairs()},
           {"complete", layout.complete()},
           {"largest_theta", {{"view", largest_theta(layout.views())}, {"light", largest_theta(layout.lights())}}},
           {"tile_metres", tile_json(btf.grid())},
           {"shell", shell_json(btf.shell())},
           {"errors", btf.has_errors()},
           {"structure", btf.has_structure()},
           {"entries", entries_json(count_values(btf))},
           {"details", details_json(btf)},
           {"warning_codes", warnings_json(btf.warnings())}});
  return text(json);
}

std::string btf_export_json(const BtfExportReport& report) {
  return text(
      {{"format", report.format}, {"pictures", report.pictures}, {"bytes", report.bytes}, {"seconds", report.seconds}});
}

std::string compression_json(const Model& model, uint64_t file_bytes) {
  const BtfRecord& record = model.btf.value();
  Json json = {{"method", record.method}};
  json.update(size_json(model, file_bytes));
  json.update(Json{{"ratio", static_cast<double>(record.raw_bytes) / static_cast<double>(file_bytes)},
                   {"psnr", record.psnr},
                   {"psnr_held_out", or_null(record.psnr_held_out)},
                   {"ser", record.ser},
                   {"relative_l2", record.relative_l2},
                   {"p99", record.p99},
                   {"evaluations_per_second", record.evaluations_per_second},
                   {"seconds", record.seconds},
                   {"verdict", record.verdict ? verdict_json(*record.verdict) : Json()},
                   {"warning_codes", warnings_json(record.warnings)},
                   {"tolerance", record.tolerance},
                   {"order", order_json(record.order)},
                   {"search", trials_json(record.search)}});
  if (!record.shapes.empty()) json["shapes"] = shapes_json(record.shapes);
  if (model.scene) {
    json["texels"] = {grid_of(model)->width, grid_of(model)->height};
    json["scene"] = reduced_json(*model.scene);
  }
  return text(json);
}

std::string btf_errors_json(const BtfErrors& errors, double p99) {
  return text({{"psnr", errors.psnr},
               {"ser", errors.ser},
               {"relative_l2", errors.relative_l2},
               {"brightness", errors.brightness},
               {"p99", p99},
               {"pairs", errors.pairs}});
}

std::string capture_json(const BtfCaptureReport& report) {
  return text({{"seconds", report.seconds},
               {"rays", report.rays},
               {"rays_per_second", report.rays_per_second},
               {"ray_share", report.ray_share ? Json(*report.ray_share) : Json()},
               {"bytes", report.bytes},
               {"views", report.views},
               {"lights", report.lights},
               {"pairs", report.pairs},
               {"views_resumed", report.views_resumed},
               {"sides", report.two_sided ? 2 : 1},
               {"open", report.open},
               {"thickness", report.thickness},
               {"reference_height", report.reference_height},
               {"warning_codes", warnings_json(report.warnings)}});
}

std::string microsurface_json(const MicrosurfaceReport& report) {
  return text({{"seconds", report.seconds},
               {"rays", report.rays},
               {"rays_per_second", report.rays_per_second},
               {"bytes", report.bytes},
               {"resolution_degrees", report.resolution_degrees},
               {"relative_standard_error", report.relative_standard_error},
               {"albedo", report.albedo}});
}

namespace {

Json material_json(const TileMaterial& material) {
  const PrincipledParameters& p = material.parameters;
  return {{"name", material.name},
          {"base_color", color(p.base_color)},
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
