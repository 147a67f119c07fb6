#include "brdf/measure/measurement.h"

#include "btf/formats/load_btf.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "model/file/model_file.h"
#include "usage/observation.h"

using namespace velour;
using namespace velour::capi;

namespace {

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
                     {"spikes", n.spikes},
                     {"out_of_gamut", n.out_of_gamut}}},
                   {"details", details_json(measurement)}});
  return text(json);
}

}  // namespace

vlr_status vlr_measurement_load(const char* path, vlr_measurement** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    *out = new vlr_measurement{load_measurement(path), {}};
  });
}

vlr_status vlr_measurement_load_create_job(const char* path, vlr_job** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, file = std::string(path)](Progress& progress) {
      progress.stage("reading", 0, 1);
      const auto measurement = load_measurement(file, progress);
      progress.check();
      output->set(measurement_json(*measurement), measurement);
    });
  });
}

vlr_status vlr_job_result_measurement(const vlr_job* job, vlr_measurement** out) {
  return guard([&] {
    require(job, "job");
    require(out, "out");
    job->job.rethrow();
    const std::lock_guard lock(job->output->mutex);
    if (!job->output->measurement) throw Error(Status::invalid_state, "This job does not read a measurement.");
    *out = new vlr_measurement{job->output->measurement, {}};
  });
}

void vlr_measurement_free(vlr_measurement* measurement) { delete measurement; }

vlr_status vlr_measurement_info_json(vlr_measurement* measurement, const char** json) {
  return guard([&] {
    require(measurement, "measurement");
    require(json, "json");
    measurement->info = measurement_json(*measurement->measurement);
    *json = measurement->info.c_str();
  });
}

vlr_status vlr_measurement_eval(const vlr_measurement* measurement, const float* wv, uint64_t count, const float* wl,
                                float* f, uint8_t* valid) {
  return guard([&] {
    require(measurement, "measurement");
    require(wv, "wv");
    require(wl, "wl");
    require(f, "f");
    require(valid, "valid");
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    const auto n = static_cast<size_t>(count);
    kept(measurement->measurement)
        ->eval({wv[0], wv[1], wv[2]}, {reinterpret_cast<const Vec3*>(wl), n}, {reinterpret_cast<Rgb*>(f), n},
               {valid, n});
  });
}

vlr_status vlr_file_info_json(const char* path, const char** json) {
  return guard([&] {
    require(path, "path");
    require(json, "json");
    thread_local std::string text;
    if (is_btf(path)) {
      text = btf_json(*load_btf(path));
    } else if (is_model_file(path)) {
      const Model model = load_model(path);
      text = model_json(model, encode_model(model).size());
    } else if (is_observation_file(path)) {
      text = observation_json(load_observation(path));
    } else {
      text = measurement_json(*load_measurement(path));
    }
    *json = text.c_str();
  });
}
