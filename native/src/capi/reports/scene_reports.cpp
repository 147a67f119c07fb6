#include "capi/reports/reports.h"

#include <algorithm>
#include <cmath>
#include "capi/guard.h"
#include "render/lights/emissive_meshes.h"
#include "render/path/vertex.h"
#include "usage/observation.h"
#include "usage/observe/scene_observer.h"

namespace velour::capi {
namespace {

/// Shares of the weight, one per octave.
Json octaves_json(const SurfaceDomain& surface) {
  constexpr size_t kBins = SurfaceDomain::kBinsOfOctave;
  Json json = Json::array();
  for (size_t begin = 0; begin < surface.footprint.size(); begin += kBins) {
    double sum = 0;
    for (size_t i = begin; i < begin + kBins; ++i) sum += surface.footprint[i];
    json.push_back(sum / surface.weight());
  }
  return json;
}

}  // namespace

Json surface_json(const SurfaceDomain& surface) {
  return {{"finest", finest_footprint(surface)},
          {"footprint", octaves_json(surface)},
          {"tile_share", seen_share_of_tile(surface)}};
}

Json reduced_json(const SceneRecord& scene) {
  Json json = {
      {"frames", scene.domain.frames},
      {"light_density", std::isfinite(scene.domain.light_density) ? Json(scene.domain.light_density) : Json(nullptr)},
      {"hash", hash_text(scene.domain.hash)},
      {"full_parameter_bytes", scene.full_parameter_bytes}};
  if (scene.full_texels[0] > 0) {
    json["full_texels"] = scene.full_texels;
    json["surface"] = surface_json(scene.domain.surface);
    json["seen_views_alone"] = scene.seen_views_alone;
  }
  if (scene.full_texels[0] == 0 || scene.seen_views_alone) {
    json["picture_error"] = scene.picture_error;
    json["full_picture_error"] = scene.full_picture_error;
  }
  return json;
}

namespace {

Json seen_views_json(const SceneDomain& domain) {
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
               {"views", seen_views_json(domain)},
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

Json sky_json(const RenderReport::Sky& sky) {
  return {{"lobes", sky.lobes}, {"relative_l2", sky.relative_l2}, {"seconds", sky.seconds}, {"cached", sky.cached}};
}

Json pilot_json(const RenderReport::Pilot& pilot) {
  return {{"pixels", pilot.pixels}, {"products", pilot.products}, {"light_share", pilot.light_share}};
}

}  // namespace

std::string scene_json(const Scene& scene) {
  const SceneInfo& info = scene.info();
  const auto around = scene.committed() ? surrounding_instance(scene) : std::nullopt;
  std::vector<Warning> warnings = info.warnings;
  if (std::ranges::any_of(scene.materials(), emits)) std::erase(warnings, warning<WarningCode::no_light>());
  return text({{"triangles", info.triangles},
               {"instances", info.instances},
               {"meshes", info.meshes},
               {"lights", info.lights},
               {"materials", info.materials},
               {"untextured", untextured_instances(scene)},
               {"camera_inside", around ? Json(*around) : Json(nullptr)},
               {"bytes", info.bytes},
               {"bvh_seconds", info.bvh_seconds},
               {"warning_codes", warnings_json(warnings)}});
}

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
               {"sky", report.sky ? sky_json(*report.sky) : Json(nullptr)},
               {"pilot", report.pilot ? pilot_json(*report.pilot) : Json(nullptr)}});
}

}  // namespace velour::capi
