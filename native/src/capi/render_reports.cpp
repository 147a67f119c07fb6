#include "capi/render_reports.h"

#include <algorithm>

#include "capi/json_text.h"
#include "render/footprint.h"
#include "render/glow_group.h"
#include "render/surroundings.h"

namespace velour::capi {
namespace {

Json sky_json(const RenderReport::Sky& sky) {
  return {{"lobes", sky.lobes}, {"relative_l2", sky.relative_l2}, {"seconds", sky.seconds}, {"cached", sky.cached}};
}

}  // namespace

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

}  // namespace velour::capi
