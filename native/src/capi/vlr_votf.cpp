#include <cmath>

#include "capi/fit_reports.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "votf/capture/data_votf.h"
#include "votf/capture/votf_capture.h"

using namespace velour;
using namespace velour::capi;

namespace {

VotfCaptureOptions converted(const vlr_votf_options& given) {
  VotfCaptureOptions options;
  for (int i = 0; i < 2; ++i) {
    options.place.origin[i] = static_cast<float>(given.origin[i]);
    options.place.period[i] = static_cast<float>(given.period[i]);
  }
  options.metres_per_unit = given.metres_per_unit;
  options.texels = given.texels;
  options.surface = given.surface;
  if (!std::isnan(given.reference_height)) options.reference_height = given.reference_height;
  options.check_views = given.check_views;
  options.seed = given.seed;
  options.threads = static_cast<int>(given.threads);
  return options;
}

DataVotfOptions of_data(const vlr_votf_options& given) {
  return {.texels = given.texels,
          .surface = given.surface,
          .check_views = given.check_views,
          .threads = static_cast<int>(given.threads)};
}

/// Creates a job that adds the VOTF found by `find(progress)` to a copy of `model`.
template <typename Find>
vlr_job* shell_job(const vlr_model* model, const char* source, Find find) {
  auto output = std::make_shared<JobOutput>();
  const auto task = [output, base = model->model, source = std::string(source ? source : ""),
                     find = std::move(find)](Progress& progress) {
    VotfCapture captured = find(progress);
    auto result = std::make_shared<Model>(*base);
    result->shell = ModelShell{std::make_shared<const VotfVolume>(std::move(captured.volume)), source, captured.errors};
    captured.volume = {};
    output->set(votf_json(*result->shell, captured.seconds, captured.warnings), result);
  };
  return new vlr_job(output, task);
}

}  // namespace

void vlr_votf_options_init(vlr_votf_options* options) {
  const VotfCaptureOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_votf_options);
  options->texels = defaults.texels;
  options->check_views = defaults.check_views;
  options->metres_per_unit = defaults.metres_per_unit;
  options->reference_height = std::nan("");
  options->source = "tile";
}

vlr_status vlr_votf_create_job(const vlr_scene* tile, const vlr_model* model, const vlr_votf_options* options,
                               vlr_job** out) {
  return guard([&] {
    require(tile, "tile");
    require(model, "model");
    require(out, "out");
    const auto given = read_options(options, vlr_votf_options_init, "vlr_votf_options");
    *out = shell_job(model, given.source, [scene = tile->scene, capture = converted(given)](Progress& progress) {
      return capture_votf(*scene, capture, progress);
    });
  });
}

vlr_status vlr_votf_data_create_job(const vlr_btf* btf, const vlr_model* model, const vlr_votf_options* options,
                                    vlr_job** out) {
  return guard([&] {
    require(btf, "btf");
    require(model, "model");
    require(out, "out");
    const auto given = read_options(options, vlr_votf_options_init, "vlr_votf_options");
    *out = shell_job(model, given.source, [data = btf->btf, capture = of_data(given)](Progress& progress) {
      return votf_of_data(*data, capture, progress);
    });
  });
}
