#include "brdf/fit/closures/closure_fit.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "model/roughened_model.h"

using namespace velour;
using namespace velour::capi;

namespace {

vlr_model* new_handle(Model model) {
  return new vlr_model{std::make_shared<const Model>(std::move(model)), {}, {}, {}};
}

const std::vector<uint8_t>& encoded(vlr_model& handle) {
  if (handle.bytes.empty()) handle.bytes = encode_model(*handle.model);
  return handle.bytes;
}

Vec3 checked_view(const float* wv) {
  const Vec3 view(wv[0], wv[1], wv[2]);
  if (!(view.z > 0.0f) || !(std::abs(glm::length(view) - 1.0f) < 1e-3f)) {
    throw Error(Status::invalid_argument, "wv must be a unit vector above the surface (z > 0).");
  }
  return view;
}

/// Calls `body(first, batch)` for consecutive runs of the `count` directions.
template <typename Body>
void for_each_batch(uint64_t count, const float* wl, const Body& body) {
  DirectionBatch batch;
  for (uint64_t first = 0; first < count; first += DirectionBatch::kCapacity) {
    batch.count = 0;
    const uint64_t end = std::min<uint64_t>(count, first + DirectionBatch::kCapacity);
    for (uint64_t i = first; i < end; ++i) batch.push({wl[3 * i], wl[3 * i + 1], wl[3 * i + 2]});
    batch.pad();
    body(first, batch);
  }
}

}  // namespace

vlr_status vlr_model_load(const char* path, vlr_model** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    *out = new_handle(load_model(path));
  });
}

vlr_status vlr_model_load_memory(const void* bytes, uint64_t size, const char* name, vlr_model** out) {
  return guard([&] {
    require(bytes, "bytes");
    require(name, "name");
    require(out, "out");
    *out = new_handle(decode_model({static_cast<const uint8_t*>(bytes), static_cast<size_t>(size)}, name));
  });
}

void vlr_model_free(vlr_model* model) { delete model; }

vlr_status vlr_model_save(const vlr_model* model, const char* path) {
  return guard([&] {
    require(model, "model");
    require(path, "path");
    save_model(*kept(model->model), path);
  });
}

vlr_status vlr_model_bytes(vlr_model* model, const void** bytes, uint64_t* size) {
  return guard([&] {
    require(model, "model");
    require(bytes, "bytes");
    require(size, "size");
    *bytes = encoded(*model).data();
    *size = encoded(*model).size();
  });
}

vlr_status vlr_model_roughened(const vlr_model* model, float roughness, vlr_model** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    *out = new_handle(roughened(*kept(model->model), roughness));
  });
}

vlr_status vlr_model_info_json(vlr_model* model, const char** json) {
  return guard([&] {
    require(model, "model");
    require(json, "json");
    model->info = model_json(*model->model, encoded(*model).size());
    *json = model->info.c_str();
  });
}

vlr_status vlr_model_eval(const vlr_model* model, const float* wv, uint64_t count, const float* wl, float* f,
                          float* pdf) {
  return guard([&] {
    require(model, "model");
    require(wv, "wv");
    require(wl, "wl");
    require(f, "f");
    const auto material = make_material(kept(model->model), 0);
    ScratchArena arena;
    const PreparedBrdf* const point = material->prepare(checked_view(wv), arena);
    RgbBatch value;
    ScalarBatch density;
    for_each_batch(count, wl, [&](uint64_t first, const DirectionBatch& batch) {
      point->eval(batch, value, density);
      for (int i = 0; i < batch.count; ++i) {
        const uint64_t at = first + static_cast<uint64_t>(i);
        const Rgb c = value.get(i);
        f[3 * at] = c.r;
        f[3 * at + 1] = c.g;
        f[3 * at + 2] = c.b;
        if (pdf) pdf[at] = density.v[i];
      }
    });
  });
}

vlr_status vlr_model_sample(const vlr_model* model, const float* wv, uint64_t count, const float* u, float* wl,
                            float* pdf) {
  return guard([&] {
    require(model, "model");
    require(wv, "wv");
    require(u, "u");
    require(wl, "wl");
    require(pdf, "pdf");
    const auto material = make_material(kept(model->model), 0);
    ScratchArena arena;
    const PreparedBrdf* const point = material->prepare(checked_view(wv), arena);
    for (uint64_t i = 0; i < count; ++i) {
      const Vec3 w = point->sample_one({u[2 * i], u[2 * i + 1]});
      wl[3 * i] = w.x;
      wl[3 * i + 1] = w.y;
      wl[3 * i + 2] = w.z;
    }
    RgbBatch value;
    ScalarBatch density;
    for_each_batch(count, wl, [&](uint64_t first, const DirectionBatch& batch) {
      point->eval(batch, value, density);
      for (int i = 0; i < batch.count; ++i) pdf[first + static_cast<uint64_t>(i)] = density.v[i];
    });
  });
}

// Closures of Blender fitted to a model.

void vlr_closure_options_init(vlr_closure_options* options) {
  const ClosureFitOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_closure_options);
  options->masking = static_cast<int32_t>(defaults.masking);
}

namespace {

ClosureFitOptions converted(const vlr_closure_options& given) {
  require_choice(given.masking, VLR_MASKING_CORRELATED, "vlr_closure_options.masking");
  ClosureFitOptions options;
  if (given.max_lobes != 0) options.max_lobes = static_cast<int>(std::min(given.max_lobes, 1000u));
  if (given.tolerance != 0) options.tolerance = given.tolerance;
  options.masking = static_cast<LobeMasking>(given.masking);
  options.threads = static_cast<int>(given.threads);
  return options;
}

}  // namespace

vlr_status vlr_model_closures_json(vlr_model* model, const vlr_closure_options* options, const char** json) {
  return guard([&] {
    require(model, "model");
    require(json, "json");
    const ClosureFitOptions fit = converted(read_options(options, vlr_closure_options_init, "vlr_closure_options"));
    Progress progress;
    model->closures = closures_json(fit_model_closures(kept(model->model), fit, progress));
    *json = model->closures.c_str();
  });
}
