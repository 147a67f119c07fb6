// Contents of the opaque handles.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "brdf/measure/measurement.h"
#include "btf/measure/btf_measurement.h"
#include "capture/tile/tile.h"
#include "material/shader_layers.h"
#include "model/model.h"
#include "plot/plot.h"
#include "realtime/lobe_rows.h"
#include "render/film/film.h"
#include "render/progressive.h"
#include "scene/scene.h"
#include "usage/observation.h"

namespace velour::capi {

/// Keeps the content of a handle alive as long as the result. Long calls read through it, so that another thread may
/// free the handle before they end, for example after a cancel.
template <typename T>
std::shared_ptr<T> kept(std::shared_ptr<T> held) {
  return held;
}

}  // namespace velour::capi

struct vlr_measurement {
  std::shared_ptr<const velour::Measurement> measurement;
  std::string info;
};

struct vlr_btf {
  std::shared_ptr<const velour::BtfMeasurement> btf;
  std::string info;
};

struct vlr_model {
  std::shared_ptr<const velour::Model> model;
  std::string info, closures;
  std::vector<uint8_t> bytes;
};

struct vlr_scene {
  std::shared_ptr<velour::Scene> scene;
  std::string info;
  uint8_t hidden_from = 0;  // of the instances added next
  float terminator = 0;     // likewise
  uint32_t steps = 1;       // matrices per instance, likewise
};

/// Exactly one member is set.
struct vlr_texture {
  std::shared_ptr<const velour::Texture<velour::Rgb>> color;
  std::shared_ptr<const velour::Texture<float>> number;
  std::optional<uint32_t> corner_colors;           // index of the mesh's set of corner colors
  std::shared_ptr<const velour::Program> program;  // whose output `output` it is
  uint32_t output = 0;
};

struct vlr_program {
  std::shared_ptr<const velour::Program> program;
};

struct vlr_shader {
  velour::ShaderLayers layers;
  /// With corrected interpolated normals (SurfaceMaterial::turned), for each reflecting layer; null: the same.
  std::vector<std::shared_ptr<const velour::Material>> turned;
  bool relief = false;                              // a layer has a normal map
  bool brushed = false;                             // a measured layer is uniform and anisotropic
  std::shared_ptr<const velour::ShellField> shell;  // of a measured layer with a silhouette; null: none
  bool shell_shaded = false;                        // as in SurfaceMaterial
  velour::MeshSets sets;
  velour::MeshSets opacity;             // sets of slots that opacity depends on
  velour::LayerWeight* last = nullptr;  // of the layer added last; null: no layer
};

/// The observation itself is immutable: merging replaces it, so that jobs keep the one they were given.
struct vlr_observation {
  std::shared_ptr<const velour::SceneObservation> observation;
  std::string info;
};

struct vlr_plot {
  velour::Plot plot;
  std::string json;
};

struct vlr_tile {
  velour::Tile tile;
  std::string info;
};

namespace velour::capi {

/// Output of a task, written before the task ends and read afterwards; `film` is itself thread-safe.
struct JobOutput {
  std::mutex mutex;
  std::string report;
  std::shared_ptr<const Model> model;
  std::shared_ptr<const SceneObservation> observation;
  std::shared_ptr<const Measurement> measurement;
  std::shared_ptr<const Plot> plot;
  std::shared_ptr<const TablePixels> table;
  std::shared_ptr<Film> film;                      // set when the job is created
  bool onto_film = false;                          // render: adds to the contents of its film
  bool rendered = false;                           // a run has begun to add its own camera rays to the film
  std::atomic<bool> stop{false};                   // render: request to end at a whole pass
  std::shared_ptr<ProgressiveRender> progressive;  // set with the job; thread-safe except run() and restart()

  /// Prepares for a new run; none may be running.
  void prepare() {
    if (onto_film && rendered) {
      throw Error(Status::invalid_state,
                  "This job has both added sums and rendered its own samples, so a new run would count them twice. "
                  "Create a new job.");
    }
    stop = false;
  }
  void set(std::string json, std::shared_ptr<const Model> result = nullptr) {
    const std::lock_guard lock(mutex);
    report = std::move(json);
    model = std::move(result);
  }
  void set(std::string json, std::shared_ptr<const TablePixels> result) {
    const std::lock_guard lock(mutex);
    report = std::move(json);
    table = std::move(result);
  }
  void set(std::string json, std::shared_ptr<const SceneObservation> result) {
    const std::lock_guard lock(mutex);
    report = std::move(json);
    observation = std::move(result);
  }
  void set(std::string json, std::shared_ptr<const Measurement> result) {
    const std::lock_guard lock(mutex);
    report = std::move(json);
    measurement = std::move(result);
  }
  void set(std::string json, std::shared_ptr<const Plot> result) {
    const std::lock_guard lock(mutex);
    report = std::move(json);
    plot = std::move(result);
  }
};

}  // namespace velour::capi

struct vlr_job {
  std::shared_ptr<velour::capi::JobOutput> output;
  std::string report;  // text last returned by vlr_job_report_json
  velour::Job job;

  vlr_job(std::shared_ptr<velour::capi::JobOutput> task_output, std::function<void(velour::Progress&)> task)
      : output(std::move(task_output)), job(std::move(task)) {}
};
