#include "base/parallel.h"
#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "realtime/light_map.h"
#include "realtime/lobe_rows.h"
#include "realtime/maps.h"
#include "velour/velour.h"

using namespace velour;
using namespace velour::capi;

namespace {

std::string mixture_json(const EnvironmentMixture& sky) {
  Json lobes = Json::array();
  for (size_t k = 0; k < sky.size(); ++k) {
    const Vec3& c = sky.center[k];
    const Rgb& color = sky.coefficient[k];
    lobes.push_back({c.x, c.y, c.z, sky.bandwidth[k], color.r, color.g, color.b});
  }
  return text({{"lobes", sky.size()},
               {"relative_l2", sky.relative_l2},
               {"seconds", sky.seconds},
               {"cached", sky.cached},
               {"mixture", std::move(lobes)}});
}

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json terms_json(const BtfMaps& maps) {
  Json terms = Json::array();
  for (const BtfMaps::Term& term : maps.terms) {
    const MultivariateLobe& lobe = term.lobe;
    terms.push_back({{"light", vector_json(lobe.light)},
                     {"view", vector_json(lobe.view)},
                     {"half", vector_json(lobe.half)},
                     {"phase", lobe.phase},
                     {"in_tile", term.in_tile},
                     {"color", vector_json(term.color)}});
  }
  return terms;
}

/// Both sides have the same levels.
Json maps_json(const std::vector<BtfMaps>& maps, Companding companding) {
  Json levels = Json::array(), sides = Json::array();
  for (const BtfMaps::Level& level : maps[0].levels) levels.push_back({level.x, level.width, level.height});
  for (const BtfMaps& side : maps) {
    sides.push_back({{"layers", side.layers}, {"terms", terms_json(side)}, {"bottom", side.bottom}, {"top", side.top}});
  }
  return {{"levels", std::move(levels)},
          {"sides", std::move(sides)},
          {"aspect", maps[0].aspect},
          {"root", companding == Companding::root}};
}

/// Stacks the maps of all sides vertically.
TablePixels stacked(std::vector<BtfMaps> maps) {
  TablePixels all = std::move(maps[0].maps);
  for (size_t i = 1; i < maps.size(); ++i) {
    all.height += maps[i].maps.height;
    all.rgba.insert(all.rgba.end(), maps[i].maps.rgba.begin(), maps[i].maps.rgba.end());
  }
  return all;
}

/// Creates a job that reports the rows returned by `make(progress)`.
template <typename Make>
vlr_job* rows_job(Make make) {
  auto output = std::make_shared<JobOutput>();
  return new vlr_job(output, [output, make = std::move(make)](Progress& progress) {
    LobeRows rows = make(progress);
    const Json json = {
        {"isotropic", rows.isotropic}, {"side", rows.side}, {"blends", rows.blends}, {"lobes", rows.lobes}};
    output->set(text(json), std::make_shared<const TablePixels>(std::move(rows.pixels)));
  });
}

}  // namespace

vlr_status vlr_light_map_create_job(const vlr_scene* scene, const char* cache_folder, uint32_t threads, vlr_job** out) {
  return guard([&] {
    require(scene, "scene");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, environment = scene->scene->environment(), count = static_cast<int>(threads),
                                folder = std::string(cache_folder ? cache_folder : "")](Progress& progress) {
      in_one_arena(count, [&] {  // the fit uses the threads of its caller
        const EnvironmentMixture sky = mixture_of_environment(environment, {}, folder, progress);
        output->set(mixture_json(sky),
                    std::make_shared<const TablePixels>(light_map(sky, environment, count, progress)));
      });
    });
  });
}

vlr_status vlr_lobe_rows_create_job(const vlr_model* model, uint32_t threads, vlr_job** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    if (is_btf(*model->model)) {
      throw Error(Status::invalid_argument, "BTF models have no lobe table; only BRDF models do.");
    }
    *out = rows_job([model = model->model, count = static_cast<int>(threads)](Progress& progress) {
      return lobe_rows(*model, count, progress);
    });
  });
}

vlr_status vlr_principled_rows_create_job(const vlr_principled_desc* desc, uint32_t threads, vlr_job** out) {
  return guard([&] {
    require(desc, "desc");
    require(out, "out");
    const auto given = read_options(desc, vlr_principled_desc_init, "vlr_principled_desc");
    *out = rows_job([parameters = parameters_of(given), count = static_cast<int>(threads)](Progress& progress) {
      return lobe_rows(parameters, count, progress);
    });
  });
}

vlr_status vlr_btf_maps_create_job(const vlr_model* model, vlr_job** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    if (!std::holds_alternative<SrbfBtf>(model->model->body)) {
      throw Error(Status::invalid_argument, "Only BTF models of method SRBF have texture maps.");
    }
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, model = model->model](Progress&) {
      const auto& btf = std::get<SrbfBtf>(model->body);
      auto maps = btf_maps(btf);
      const std::string json = text(maps_json(maps, btf.companding));
      output->set(json, std::make_shared<const TablePixels>(stacked(std::move(maps))));
    });
  });
}

vlr_status vlr_shell_maps_create_job(const vlr_model* model, vlr_job** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    if (!model->model->shell) throw Error(Status::invalid_argument, "The model has no silhouette (VOTF).");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, volume = model->model->shell->volume](Progress&) {
      const VotfVolume& v = *volume;
      const std::string json = text({{"layers", v.depth},
                                     {"bottom", v.bottom},
                                     {"top", v.top},
                                     {"reference", v.reference},
                                     {"aspect", v.aspect},
                                     {"reach", v.reach},
                                     {"open", !v.closed}});
      output->set(json, std::make_shared<const TablePixels>(shell_maps(v)));
    });
  });
}

vlr_status vlr_job_result_table(const vlr_job* job, const float** rgba, uint32_t* width, uint32_t* height) {
  return guard([&] {
    require(job, "job");
    require(rgba, "rgba");
    require(width, "width");
    require(height, "height");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    const auto& table = job->output->table;
    if (!table) throw Error(Status::invalid_state, "This job does not produce a table.");
    *rgba = table->rgba.data();
    *width = table->width;
    *height = table->height;
  });
}
