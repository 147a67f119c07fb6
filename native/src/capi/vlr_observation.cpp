// Observations of scene usage, and the job that makes them.
#include "usage/observation.h"

#include <algorithm>
#include <chrono>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "usage/observe/scene_observer.h"

using namespace velour;
using namespace velour::capi;

namespace {

vlr_observation* new_handle(std::shared_ptr<const SceneObservation> observation) {
  return new vlr_observation{std::move(observation), {}};
}

}  // namespace

vlr_status vlr_observation_create(vlr_observation** out) {
  return guard([&] {
    require(out, "out");
    *out = new_handle(std::make_shared<const SceneObservation>());
  });
}

vlr_status vlr_observation_load(const char* path, vlr_observation** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    *out = new_handle(std::make_shared<const SceneObservation>(load_observation(path)));
  });
}

vlr_status vlr_observation_save(const vlr_observation* observation, const char* path) {
  return guard([&] {
    require(observation, "observation");
    require(path, "path");
    save_observation(*kept(observation->observation), path);
  });
}

void vlr_observation_free(vlr_observation* observation) { delete observation; }

vlr_status vlr_observation_merge(vlr_observation* into, const vlr_observation* other) {
  return guard([&] {
    require(into, "into");
    require(other, "other");
    auto merged = std::make_shared<SceneObservation>(*into->observation);
    merge(*merged, *other->observation);
    into->observation = std::move(merged);
  });
}

vlr_status vlr_observation_info_json(vlr_observation* observation, const char** json) {
  return guard([&] {
    require(observation, "observation");
    require(json, "json");
    observation->info = observation_json(*observation->observation);
    *json = observation->info.c_str();
  });
}

void vlr_observe_options_init(vlr_observe_options* options) {
  const ObserverOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_observe_options);
  options->width = static_cast<uint32_t>(defaults.width);
  options->height = static_cast<uint32_t>(defaults.height);
  options->bounces = static_cast<uint32_t>(defaults.bounces);
}

namespace {

/// Values out of the range of int become -1, which check_observer() rejects.
int whole(uint32_t value) { return value > 0x7fffffffu ? -1 : static_cast<int>(value); }

ObserverOptions converted(const vlr_observe_options& given) {
  return {whole(given.width), whole(given.height), whole(given.bounces), whole(given.threads), given.seed};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

vlr_status vlr_observe_create_job(const vlr_scene* scene, uint32_t material, const vlr_observe_options* options,
                                  vlr_job** out) {
  return guard([&] {
    require(scene, "scene");
    require(out, "out");
    const ObserverOptions given = converted(read_options(options, vlr_observe_options_init, "vlr_observe_options"));
    check_observer(*scene->scene, material, given);
    auto output = std::make_shared<JobOutput>();
    const auto task = [output, material, given,
                       source = std::shared_ptr<const Scene>(scene->scene)](Progress& progress) {
      const auto start = std::chrono::steady_clock::now();
      auto observation = std::make_shared<const SceneObservation>(observe(*source, material, given, progress));
      output->set(observe_json(*observation, seconds_since(start)), observation);
    };
    *out = new vlr_job(output, task);
  });
}

vlr_status vlr_job_result_observation(const vlr_job* job, vlr_observation** out) {
  return guard([&] {
    require(job, "job");
    require(out, "out");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    if (!job->output->observation)
      throw Error(Status::invalid_state, "This job does not produce a scene usage (observation).");
    *out = new_handle(job->output->observation);
  });
}

namespace {

double outside(const Model& model, const SceneObservation& frame) {
  if (!is_reduced(model)) return 0.0;
  if (const TexelGrid* grid = grid_of(model)) {
    const double finer = out_of_resolution(std::max(grid->width, grid->height), frame);
    const double views = model.scene->seen_views_alone ? out_of_views(model.scene->domain, frame) : 0.0;
    return std::max(finer, views);
  }
  return out_of_domain(model.scene->domain, std::get<ParametricBrdf>(model.body).views, frame);
}

}  // namespace

vlr_status vlr_model_out_of_domain(const vlr_model* model, const vlr_observation* frame, double* share) {
  return guard([&] {
    require(model, "model");
    require(frame, "frame");
    require(share, "share");
    *share = outside(*kept(model->model), *kept(frame->observation));
  });
}
