// Fits of BTF models, and their errors.
#include "capi/btf_reports.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "compress/make_fitter.h"
#include "compress/scene_reduction.h"
#include "model/model_file.h"

using namespace velour;
using namespace velour::capi;

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

vlr_status vlr_compress_create_job(const vlr_btf* btf, const vlr_compress_options* options, vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(out, "out");
    const CompressOptions given = converted(read_options(options, vlr_compress_options_init, "vlr_compress_options"));
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, given, source = btf->btf](Progress& progress) {
      const auto compress = given.for_scene ? compress_for_scene : compress_btf;
      auto model = std::make_shared<const Model>(compress(*source, given, progress));
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
