#include "capi/reports.h"

#include <tbb/info.h>

#include <algorithm>
#include <cmath>

#include "btf/tensor_bytes.h"
#include "btf/tensor_contraction.h"
#include "btf/tensor_evaluator.h"
#include "capi/json_text.h"
#include "capi/scene_reports.h"
#include "domain/hash_text.h"
#include "model/order_json.h"
#include "render/footprint.h"
#include "render/glow_group.h"
#include "render/surroundings.h"
#include "scene/embree_scene.h"
#include "srbf/simd_target.h"
#include "velour/version.h"

namespace velour::capi {

namespace {

Json by_view_angle(const ErrorByViewAngle& errors) {
  // In the order of the angles, not of their texts.
  Json json = Json::object();
  for (const char* angle : {"5", "30", "60", "75", "85"}) {
    const auto found = errors.find(angle);
    json[angle] = found != errors.end() ? or_null(found->second) : Json(nullptr);
  }
  return json;
}

Json narrow_views(const Comparison& comparison) {
  Json json = Json::array();
  for (const auto& [degrees, share] : comparison.narrow_views) json.push_back(degrees);
  return json;
}

Json errors_of(const Comparison& comparison) {
  return {
      {"relative_l2", comparison.relative_l2}, {"by_view_angle", by_view_angle(comparison.by_view_angle)},
      {"log_rms", comparison.log_rms},         {"noise_by_view_angle", by_view_angle(comparison.noise_by_view_angle)},
      {"samples", comparison.samples},         {"narrow_views", narrow_views(comparison)}};
}

Json colour(const Rgb& c) { return {c.r, c.g, c.b}; }

Json peer_of(const GgxParameters& p) {
  return {{"ggx",
           {{"alpha", {p.alpha.x, p.alpha.y}},
            {"f0", colour(p.f0)},
            {"f90", colour(p.f90)},
            {"diffuse", colour(p.diffuse)}}}};
}

Json peer_of(const PrincipledParameters& p) {
  return {{"principled",
           {{"base_color", colour(p.base_color)},
            {"metallic", p.metallic},
            {"roughness", p.roughness},
            {"specular", p.specular},
            {"specular_tint", colour(p.specular_tint)},
            {"coat", p.coat},
            {"coat_roughness", p.coat_roughness}}}};
}

Json count_json(const ScatteredBrdf& brdf) { return {{"lobes", brdf.lobe_count()}}; }
Json count_json(const ParametricBrdf& brdf) { return {{"lobes", brdf.lobe_count()}}; }
Json count_json(const FactoredBtf& btf) { return {{"components", btf.components()}}; }

/// Of the side of most lobes.
Json count_json(const SrbfBtf& btf) {
  size_t lobes = 0, coefficients = 0;
  for (const SrbfSide& side : btf.sides) {
    lobes = std::max(lobes, side.lobes.size());
    coefficients = std::max(coefficients, side.coefficients());
  }
  return {{"lobes", lobes}, {"coefficients", coefficients}};
}

/// Of the side of most coefficients: a texel's.
Json count_json(const TensorBtf& btf) {
  size_t coefficients = 0;
  for (const TensorSide& side : btf.sides) {
    coefficients = std::max(coefficients, size_t{side.members} * side.rank.texel);
  }
  return {{"coefficients", coefficients}};
}

}  // namespace

Json size_json(const Model& model, uint64_t file_bytes) {
  return std::visit(
      [&](const auto& body) {
        Json json = count_json(body);
        json.update(Json{{"bytes", file_bytes}, {"parameter_bytes", body.parameter_bytes()}});
        return json;
      },
      model.body);
}

namespace {

Json views_json(const ViewRange& views) { return {views.begin, views.end}; }

/// What only one kind of model has to say.
Json own_json(const ScatteredBrdf& brdf) {
  return {{"kernel", kernel_name(brdf.kernel)},
          {"isotropic", brdf.isotropic},
          {"views", brdf.views.size()},
          {"max_lobes_per_view", brdf.max_lobes_per_view()}};
}

Json own_json(const ParametricBrdf& brdf) {
  const auto half = std::count(brdf.space.begin(), brdf.space.end(), LobeSpace::half);
  return {{"kernel", kernel_name(Kernel::gaussian)},
          {"isotropic", brdf.isotropic},
          {"cells", brdf.cells},
          {"symmetric", brdf.symmetric},
          {"view_range", views_json(brdf.views)},
          {"spaces", {{"light", brdf.lobe_count() - half}, {"half", half}}}};
}

template <class Btf>
Json btf_own_json(const Btf& btf) {
  return {{"texels", {btf.grid.width, btf.grid.height}},
          {"tile_metres", tile_json(btf.grid)},
          {"views", btf.layout.views().size()},
          {"lights", btf.layout.lights().size()},
          {"companding", btf.companding == Companding::root ? "root" : "none"}};
}

Json own_json(const FactoredBtf& btf) { return btf_own_json(btf); }

const char* where(bool below) { return below ? "below" : "above"; }

/// What only one kind of side has to say.
Json own_side_json(const SrbfBtf&, const SrbfSide& side) {
  return {{"lobes", {{"tile", side.tile_lobes}, {"texel", side.lobes.size() - side.tile_lobes}}}};
}
Json own_side_json(const TensorBtf& btf, const TensorSide& side) {
  const TensorSide::Ranks& rank = side.rank;
  const TensorBytes bytes = bytes_of(side);
  return {{"clusters", side.clusters.size()},
          {"members", side.members},
          {"ranks", {{"texel", rank.texel}, {"view", rank.view}, {"light", rank.light}, {"color", rank.color}}},
          {"relief", !side.levels.at(0).relief.empty()},
          {"table_bytes", TensorContraction::bytes(btf, side, TensorEvaluator::kMostTableBytes)},
          {"bytes",
           {{"coefficients", bytes.coefficients},
            {"members", bytes.members},
            {"relief", bytes.relief},
            {"factors", bytes.factors},
            {"cores", bytes.cores},
            {"scales", bytes.scales}}}};
}

/// The sides of a BTF, then those that another one serves; these have the same fields.
template <class Btf>
Json sided_json(const Btf& btf) {
  Json json = btf_own_json(btf), sides = Json::array();
  for (const auto& side : btf.sides) {
    Json& row = sides.emplace_back(Json{{"view", where(side.view_below)}, {"light", where(side.light_below)}});
    row.update(own_side_json(btf, side));
    row.update(Json{{"parameter_bytes", side.parameter_bytes()}, {"as", nullptr}});
  }
  for (const SharedSide& shared : btf.shared) {
    Json row = sides.at(shared.side);
    for (auto& [key, value] : row.items()) value = nullptr;
    row.update(Json{{"view", where(shared.view_below)},
                    {"light", where(shared.light_below)},
                    {"parameter_bytes", 0},
                    {"as", shared.side}});
    sides.push_back(row);
  }
  json["sides"] = std::move(sides);
  return json;
}

Json own_json(const SrbfBtf& btf) { return sided_json(btf); }
Json own_json(const TensorBtf& btf) { return sided_json(btf); }

/// What the fit found out, of a BRDF.
Json record_json(const FitRecord& fit) {
  return {{"relative_l2", fit.relative_l2},
          {"by_view_angle", by_view_angle(fit.by_view_angle)},
          {"albedo_by_view_angle", by_view_angle(fit.albedo_by_view_angle)},
          {"albedo_max", fit.albedo_max},
          {"reciprocity", fit.reciprocity},
          {"measured_reciprocity", or_null(fit.measured_reciprocity)},
          {"tolerance", fit.tolerance},
          {"seconds", fit.seconds},
          {"seed", fit.seed},
          {"all_data", fit.all_data},
          {"warnings", fit.warnings},
          {"order", order_json(fit.order)}};
}

/// The same of a BTF.
Json record_json(const BtfRecord& btf) {
  const bool timed = btf.evaluations_per_second > 0;  // not in files of earlier versions
  const bool measured = btf.relative_l2 > 0;
  return {{"method", btf.method},
          {"psnr", btf.psnr},
          {"psnr_held_out", or_null(btf.psnr_held_out)},
          {"ser", btf.ser},
          {"p99", btf.p99},
          {"raw_bytes", btf.raw_bytes},
          {"evaluations_per_second", timed ? Json(btf.evaluations_per_second) : Json()},
          {"seconds", btf.seconds},
          {"seed", btf.seed},
          {"warnings", btf.warnings},
          {"relative_l2", measured ? Json(btf.relative_l2) : Json()},
          {"tolerance", btf.tolerance},
          {"order", order_json(btf.order)},
          {"search", trials_json(btf.search)},
          {"shapes", shapes_json(btf.shapes)}};
}

}  // namespace

std::string system_json() {
  const EmbreeInfo embree = embree_info();
  return text({{"version", VELOUR_VERSION_TEXT},
               {"embree", {{"version", embree.version}, {"path", embree.path}}},
               {"simd", simd_target()},
               {"simd_targets", simd_targets()},
               {"threads", tbb::info::default_concurrency()},
               {"build_type", VELOUR_BUILD_TYPE}});
}

std::string measurement_json(const Measurement& measurement) {
  const EntryCounts& n = measurement.counts();
  Json json = source_json("measurement", measurement.provenance());
  json.update(Json{{"isotropic", measurement.isotropic()},
                   {"entries",
                    {{"total", n.total},
                     {"valid", n.valid},
                     {"negative", n.negative},
                     {"not_finite", n.not_finite},
                     {"below_horizon", n.below_horizon},
                     {"out_of_gamut", n.out_of_gamut}}},
                   {"details", details_json(measurement)}});
  return text(json);
}

namespace {

Json shell_json(const ModelShell& shell) {
  const OcclusionVolume& v = *shell.volume;
  const auto of_errors = [&](double OcclusionErrors::*value) {
    return shell.errors ? Json((*shell.errors).*value) : Json();
  };
  return {{"source", shell.source},
          {"bytes", v.parameter_bytes()},
          {"points", {v.width, v.height, v.depth}},
          {"heights", {v.bottom, v.top}},
          {"tile_width", v.tile_width > 0 ? Json(v.tile_width) : Json()},
          {"closed", v.closed},
          {"coverage", of_errors(&OcclusionErrors::coverage)},
          {"wrong", of_errors(&OcclusionErrors::wrong)}};
}

}  // namespace

std::string votf_json(const ModelShell& shell, double seconds, const std::vector<std::string>& warnings) {
  Json json = shell_json(shell);
  json.update(Json{{"seconds", seconds}, {"warnings", warnings}});
  return text(json);
}

std::string model_json(const Model& model, uint64_t file_bytes) {
  Json json = {{"kind", "model"}, {"model", model_kind(model)}};
  json.update(std::visit([](const auto& brdf) { return own_json(brdf); }, model.body));
  json.update(size_json(model, file_bytes));
  json.update(model.btf ? record_json(*model.btf) : record_json(model.fit));
  json["source"] = {{"name", model.source.name}, {"format", model.source.format}, {"sha256", model.source.sha256}};
  if (model.scene) json["scene"] = reduced_json(*model.scene);
  if (model.shell) json["shell"] = shell_json(*model.shell);
  return text(json);
}

std::string fit_json(const Model& model, uint64_t file_bytes) {
  Json json = size_json(model, file_bytes);
  json.update(Json{{"seconds", model.fit.seconds},
                   {"relative_l2", model.fit.relative_l2},
                   {"by_view_angle", by_view_angle(model.fit.by_view_angle)},
                   {"albedo_max", model.fit.albedo_max},
                   {"reciprocity", model.fit.reciprocity},
                   {"measured_reciprocity", or_null(model.fit.measured_reciprocity)},
                   {"warnings", model.fit.warnings},
                   {"order", order_json(model.fit.order)}});
  if (const auto* brdf = std::get_if<ParametricBrdf>(&model.body)) json["view_range"] = views_json(brdf->views);
  if (model.scene) json["scene"] = reduced_json(*model.scene);
  return text(json);
}

std::string comparison_json(const Comparison& comparison) { return text(errors_of(comparison)); }

std::string peer_json(const PeerFit& fit) {
  Json json = errors_of(fit.error);
  json.update(Json{{"seconds", fit.seconds}, {"parameter_bytes", fit.parameter_bytes()}});
  json.update(std::visit([](const auto& p) { return peer_of(p); }, fit.parameters));
  return text(json);
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
               {"warnings", report.warnings}});
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

std::string scene_json(const Scene& scene) {
  const SceneInfo& info = scene.info();
  const auto around = scene.committed() ? surrounding_instance(scene) : std::nullopt;
  std::vector<std::string> warnings = info.warnings;
  if (std::ranges::any_of(scene.materials(), glows)) std::erase(warnings, kNoLightWarning);
  return text({{"triangles", info.triangles},
               {"instances", info.instances},
               {"meshes", info.meshes},
               {"lights", info.lights},
               {"materials", info.materials},
               {"untextured", untextured_instances(scene)},
               {"camera_inside", around ? Json(*around) : Json(nullptr)},
               {"bytes", info.bytes},
               {"bvh_seconds", info.bvh_seconds},
               {"warnings", warnings}});
}

namespace {

Json sky_json(const RenderReport::Sky& sky) {
  return {{"lobes", sky.lobes}, {"relative_l2", sky.relative_l2}, {"seconds", sky.seconds}, {"cached", sky.cached}};
}

}  // namespace

std::string render_json(const RenderReport& report) {
  Json stages = Json::object();
  for (const RenderStage& stage : report.stages) stages[stage.name] = stage.seconds;
  return text({{"seconds", report.seconds},
               {"rays", report.rays},
               {"samples_per_second", report.samples_per_second},
               {"ray_share", report.ray_share ? Json(*report.ray_share) : Json(nullptr)},
               {"stages", stages},
               {"nan_samples", report.nan_samples},
               {"spp", report.spp},
               {"passes", report.passes},
               {"noise", report.noise},
               {"spp_mean", report.spp_mean},
               {"block_noise", report.block_noise},
               {"blocks_unfinished", report.blocks_unfinished ? Json(*report.blocks_unfinished) : Json(nullptr)},
               {"sky", report.sky ? sky_json(*report.sky) : Json(nullptr)}});
}

namespace {

Json views_json(const SceneDomain& domain) {
  if (!(domain.weight() > 0.0)) return nullptr;
  return views_json(view_range(domain));
}

Json own_json(const SceneObservation& observation) {
  const SceneDomain& domain = observation.domain;
  const double weight = domain.weight();
  Json json = {{"frames", domain.frames},
               {"camera_rays", domain.camera_rays},
               {"hits", observation.hits.size()},
               {"weight", weight},
               {"share", domain.camera_rays > 0 ? weight / static_cast<double>(domain.camera_rays) : 0.0},
               {"views", views_json(domain)},
               {"light_density", std::isfinite(domain.light_density) ? Json(domain.light_density) : Json(nullptr)},
               {"hash", hash_text(domain.hash)}};
  if (domain.surface.weight() > 0) json["surface"] = surface_json(domain.surface);
  return json;
}

}  // namespace

std::string observation_json(const SceneObservation& observation) {
  Json json = {{"kind", "observation"}};
  json.update(own_json(observation));
  return text(json);
}

std::string observe_json(const SceneObservation& observation, double seconds) {
  Json json = {{"seconds", seconds}};
  json.update(own_json(observation));
  return text(json);
}

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
