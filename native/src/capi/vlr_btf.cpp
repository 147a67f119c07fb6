// Bidirectional texture functions.

#include "btf/fit/btf_fit.h"
#include "btf/formats/btf_export.h"
#include "btf/formats/load_btf.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "model/file/model_file.h"
#include "usage/btf/scene_reduction.h"
#include "verdict/btf_verdict.h"

using namespace velour;
using namespace velour::capi;

namespace {

void require_enum(const char* field, int32_t value, int32_t last) {
  if (value >= 0 && value <= last) return;
  throw Error(Status::invalid_argument, std::string("vlr_btf_options.") + field + " is " + std::to_string(value) +
                                            ", which is not a valid value.");
}

BtfLoadOptions converted(const vlr_btf_options& given) {
  require_enum("values", given.values, VLR_BTF_RADIANCE);
  require_enum("colors", given.colors, VLR_BTF_XYZ);
  BtfLoadOptions options;
  options.values = static_cast<BtfValues>(given.values);
  options.colors = static_cast<BtfColors>(given.colors);
  if (given.gamma != 0) options.curve.gamma = given.gamma;
  const Vec2 tile(given.tile_metres[0], given.tile_metres[1]);
  if (tile != Vec2(0)) options.tile_metres = tile;
  if (given.layer) options.layer = given.layer;
  require_enum("angles", given.angles, VLR_BTF_RADIANS);
  options.angles = static_cast<BtfAngles>(given.angles);
  return options;
}

void require_count(const char* what, uint64_t given, uint64_t needed) {
  if (given == needed) return;
  throw Error(Status::invalid_argument, std::string("The array for ") + what + " has " + std::to_string(given) +
                                            " numbers; it must have " + std::to_string(needed) + ".");
}

}  // namespace

void vlr_btf_options_init(vlr_btf_options* options) {
  *options = {};
  options->struct_size = sizeof(vlr_btf_options);
}

vlr_status vlr_btf_load(const char* path, const vlr_btf_options* options, vlr_btf** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    const BtfLoadOptions given = converted(read_options(options, vlr_btf_options_init, "vlr_btf_options"));
    *out = new vlr_btf{load_btf(path, given), {}};
  });
}

void vlr_btf_free(vlr_btf* btf) { delete btf; }

vlr_status vlr_btf_info_json(vlr_btf* btf, const char** json) {
  return guard([&] {
    require(btf, "btf");
    require(json, "json");
    btf->info = btf_json(*btf->btf);
    *json = btf->info.c_str();
  });
}

vlr_status vlr_btf_angles(const vlr_btf* btf, double* angles, uint64_t count) {
  return guard([&] {
    require(btf, "btf");
    require(angles, "angles");
    const auto source = kept(btf->btf);
    const PairLayout& layout = source->layout();
    require_count("angles", count, 4 * layout.pairs());
    for (uint64_t p = 0; p < layout.pairs(); ++p) {
      const PolarAngles &light = layout.lights()[layout.light_of(p)], &view = layout.views()[layout.view_of(p)];
      const double four[] = {light.theta, light.phi, view.theta, view.phi};
      std::copy_n(four, 4, angles + 4 * p);
    }
  });
}

vlr_status vlr_btf_read(const vlr_btf* btf, uint64_t first, uint64_t pairs, uint16_t* halves, uint64_t count) {
  return guard([&] {
    require(btf, "btf");
    require(halves, "halves");
    const auto source = kept(btf->btf);
    if (pairs > source->layout().pairs())
      throw Error(Status::invalid_argument, "pairs is " + std::to_string(pairs) + ", more than the pairs of the BTF.");
    require_count("halves", count, pairs * source->grid().texels() * 3);
    source->read_pairs(first, pairs, {halves, static_cast<size_t>(count)});
  });
}

vlr_status vlr_btf_export_create_job(const vlr_btf* btf, const char* path, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(path, "path");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, source = btf->btf, target = std::string(path)](Progress& progress) {
      output->set(btf_export_json(export_btf(*source, target, progress)));
    });
  });
}

void vlr_compress_options_init(vlr_compress_options* options) {
  const CompressOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_compress_options);
  options->method = static_cast<int32_t>(defaults.method);
  options->companding = static_cast<int32_t>(defaults.companding);
}

namespace {

CompressOptions converted(const vlr_compress_options& given) {
  if (given.method < VLR_COMPRESS_SVD || given.method > VLR_COMPRESS_SVD_VIEW) {
    throw Error(Status::invalid_argument,
                "vlr_compress_options.method is " + std::to_string(given.method) + ", not a VLR_COMPRESS value.");
  }
  if (given.companding != VLR_COMPAND_NONE && given.companding != VLR_COMPAND_ROOT) {
    throw Error(Status::invalid_argument, "vlr_compress_options.companding is " + std::to_string(given.companding) +
                                              ", not a VLR_COMPAND value.");
  }
  if (!(given.tolerance >= 0 && given.tolerance < 1)) {
    throw Error(Status::invalid_argument, "vlr_compress_options.tolerance is " + std::to_string(given.tolerance) +
                                              "; it must be at least 0 (none) and below 1.");
  }
  CompressOptions options;
  options.tolerance = given.tolerance;
  options.memory = given.memory;
  if (given.checkpoint) options.checkpoint = given.checkpoint;
  options.resume = given.resume != 0;
  options.method = static_cast<CompressMethod>(given.method);
  options.companding = static_cast<Companding>(given.companding);
  options.bytes = given.bytes;
  options.seed = given.seed;
  options.threads = static_cast<int>(given.threads);
  options.clusters = given.clusters;
  options.members = given.members;
  options.relief = given.no_relief == 0;
  if (given.held_out) options.held_out = given.held_out->btf;
  if (given.for_scene) options.for_scene = given.for_scene->observation;
  if (given.full_model) options.full_model = given.full_model->model;
  return options;
}

}  // namespace

namespace {

Model compress_and_judge(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  constexpr double kFitShare = 0.98;  // of the time
  Model model = [&] {
    const Progress::Span fitting(progress, 0, kFitShare);
    return compress_btf(measurement, options, progress);
  }();
  progress.stage("comparing pictures", kFitShare, 1);
  model.btf.value().verdict = judge_btf(measurement, images_of(model.body), progress);
  progress.update(1);
  return model;
}

}  // namespace

vlr_status vlr_compress_create_job(const vlr_btf* btf, const vlr_compress_options* options, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(out, "out");
    const CompressOptions given = converted(read_options(options, vlr_compress_options_init, "vlr_compress_options"));
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, given, source = btf->btf](Progress& progress) {
      auto model = std::make_shared<const Model>(given.for_scene ? compress_for_scene(*source, given, progress)
                                                                 : compress_and_judge(*source, given, progress));
      output->set(compression_json(*model, encode_model(*model).size()), model);
    });
  });
}

vlr_status vlr_compress_size(const vlr_btf* btf, const vlr_compress_options* options, uint64_t* memory,
                             uint64_t* least_memory, uint64_t* bytes) {
  return guard([&] {
    require(btf, "btf");
    const FitSize size =
        fit_size(*kept(btf->btf), converted(read_options(options, vlr_compress_options_init, "vlr_compress_options")));
    if (memory) *memory = size.memory;
    if (least_memory) *least_memory = size.least_memory;
    if (bytes) *bytes = size.bytes;
  });
}

vlr_status vlr_btf_compare_create_job(const vlr_btf* btf, const vlr_model* model, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(model, "model");
    require(out, "out");
    if (!is_btf(*model->model)) {
      throw Error(Status::invalid_argument, "The model is a BRDF model; a BTF can only be compared with a BTF model.");
    }
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, source = btf->btf, fitted = model->model](Progress& progress) {
      progress.stage("comparing", 0, 1);
      output->set(btf_errors_json(compare_with_model(*source, *fitted, 0, progress), fitted->btf->p99));
    });
  });
}

vlr_status vlr_btf_compare_btf_create_job(const vlr_btf* btf, const vlr_btf* other, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(other, "other");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, truth = btf->btf, table = other->btf](Progress& progress) {
      progress.stage("comparing", 0, 1);
      const double p99 = percentile_99(*table, progress);
      output->set(btf_errors_json(compare_with_table(*truth, *table, p99, 0, progress), p99));
    });
  });
}
