// Fit, compare and capture jobs.
#include "brdf/fit/error/compare.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/fit_model.h"
#include "brdf/fit/peer.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/reports/reports.h"
#include "capture/goniometer/microsurface.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "verdict/verdict.h"

using namespace velour;
using namespace velour::capi;

void vlr_fit_options_init(vlr_fit_options* options) {
  const FitOptions defaults;
  *options = {};
  options->struct_size = sizeof(vlr_fit_options);
  options->kernel = static_cast<int32_t>(defaults.kernel);
  options->tolerance = defaults.tolerance;
  options->max_lobes = static_cast<uint32_t>(defaults.max_lobes);
  options->align_views = defaults.align_views ? 1 : 0;
  options->model = static_cast<int32_t>(kDefaultModelKind);
}

namespace {

ModelKind kind_of(const vlr_fit_options& given) {
  if (given.model < VLR_MODEL_SCATTERED || given.model > VLR_MODEL_AUTO) {
    throw Error(Status::invalid_argument,
                "vlr_fit_options.model is " + std::to_string(given.model) + ", not a VLR_MODEL value.");
  }
  return static_cast<ModelKind>(given.model);
}

/// Bytes of the model's file once it has a verdict, which no text of a verdict exceeds.
uint64_t size_with_verdict(Model model) {
  model.fit.verdict = Verdict{LookQuality::poor, 1.234e-5, 1.234e-5, LookReason::measurement_noise, 1.234e-5};
  return encode_model(model).size();
}

FitOptions converted(const vlr_fit_options& given) {
  if (given.kernel != VLR_KERNEL_GAUSSIAN && given.kernel != VLR_KERNEL_ABEL_POISSON) {
    throw Error(Status::invalid_argument,
                "vlr_fit_options.kernel is " + std::to_string(given.kernel) + ", not a VLR_KERNEL value.");
  }
  FitOptions options;
  options.kernel = static_cast<Kernel>(given.kernel);
  options.tolerance = given.tolerance;
  options.max_lobes = static_cast<int>(given.max_lobes);
  options.max_bytes = given.max_bytes;
  options.size_of = size_with_verdict;
  options.seed = given.seed;
  options.threads = static_cast<int>(given.threads);
  options.all_data = given.all_data != 0;
  options.align_views = given.align_views != 0;
  options.limit_albedo = given.limit_albedo != 0;
  options.symmetric = given.symmetric != 0;
  if (given.for_scene) options.for_scene = given.for_scene->observation;
  if (given.full_model) options.full_model = given.full_model->model;
  return options;
}

MicrosurfaceOptions converted(const vlr_microsurface_options& given) {
  MicrosurfaceOptions options;
  options.roughness = given.roughness;
  options.anisotropy = given.anisotropy;
  if (given.metal) options.metal = given.metal;
  options.base_albedo = {given.base_albedo[0], given.base_albedo[1], given.base_albedo[2]};
  options.base_share = given.base_share;
  options.ior = given.ior;
  options.flake_roughness = given.flake_roughness;
  options.rays = given.rays;
  options.seed = given.seed;
  options.threads = static_cast<int>(given.threads);
  return options;
}

/// The verdict on a model of any scene; none on scene models.
std::optional<Verdict> verdict_on(const Measurement& measurement, const std::shared_ptr<const Model>& model,
                                  bool explained, int threads, Progress& progress) {
  if (is_reduced(*model)) return std::nullopt;
  return judge_look(measurement, *make_material(model, 0), explained, threads, progress);
}

Model fit_and_judge(ModelKind kind, const Measurement& measurement, FitOptions options, Progress& progress) {
  constexpr double kFitShare = 0.9;  // of the time
  const auto judged = [&](const Model& model, bool explained, Progress& judging) {
    return verdict_on(measurement, std::make_shared<const Model>(model), explained, options.threads, judging);
  };
  options.verdict_on = [&](const Model& model, Progress& judging) { return judged(model, false, judging); };
  Model model;
  {
    const Progress::Span fitting(progress, 0, kFitShare);
    model = fit_model(kind, measurement, options, progress);
  }
  progress.stage("comparing pictures", kFitShare, 1);
  const std::optional<Verdict>& verdict = model.fit.verdict;
  if (!verdict || verdict->quality != LookQuality::good) model.fit.verdict = judged(model, true, progress);
  if (model.fit.verdict && !measurement.samples().empty()) lower_for_samples(model.fit, *model.fit.verdict);
  progress.update(1);
  return model;
}

Peer checked_peer(int32_t peer) {
  if (peer < VLR_PEER_GGX || peer > VLR_PEER_PLAIN_PRINCIPLED) {
    throw Error(Status::invalid_argument, "peer is " + std::to_string(peer) + ", not a VLR_PEER value.");
  }
  return static_cast<Peer>(peer);
}

vlr_job* peer_job(std::shared_ptr<const Measurement> measurement, Peer peer) {
  auto output = std::make_shared<JobOutput>();
  return new vlr_job(output, [output, peer, source = std::move(measurement)](Progress& progress) {
    output->set(peer_json(judge_peer(*source, peer, 0, progress)));
  });
}

}  // namespace

vlr_status vlr_fit_create_job(const vlr_measurement* measurement, const vlr_fit_options* options, vlr_job** out) {
  return guard([&] {
    require(measurement, "measurement");
    require(out, "out");
    const auto given = read_options(options, vlr_fit_options_init, "vlr_fit_options");
    const ModelKind kind = kind_of(given);
    const FitOptions fit = converted(given);
    if (kind == ModelKind::parametric && fit.kernel != Kernel::gaussian) {
      throw Error(
          Status::invalid_argument,
          "Parametric models support only the Gaussian kernel; fit a per-view model (scattered) for other kernels.");
    }
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, kind, fit, source = measurement->measurement](Progress& progress) {
      auto model = std::make_shared<const Model>(fit_and_judge(kind, *source, fit, progress));
      output->set(fit_json(*model, encode_model(*model).size()), model);
    });
  });
}

vlr_status vlr_compare_create_job(const vlr_measurement* measurement, const vlr_model* model, vlr_job** out) {
  return guard([&] {
    require(measurement, "measurement");
    require(model, "model");
    require(out, "out");
    auto output = std::make_shared<JobOutput>();
    const auto task = [output, source = measurement->measurement, fitted = model->model](Progress& progress) {
      const Comparison errors = compare(*source, *make_material(fitted, 0), progress);
      output->set(comparison_json(errors, verdict_on(*source, fitted, true, 0, progress)));
    };
    *out = new vlr_job(output, task);
  });
}

vlr_status vlr_compare_peer_create_job(const vlr_measurement* measurement, int32_t peer, vlr_job** out) {
  return guard([&] {
    require(measurement, "measurement");
    require(out, "out");
    *out = peer_job(measurement->measurement, checked_peer(peer));
  });
}

vlr_status vlr_model_peer_create_job(const vlr_model* model, int32_t peer, vlr_job** out) {
  return guard([&] {
    require(model, "model");
    require(out, "out");
    const auto fitted = kept(model->model);
    const auto* parametric = std::get_if<ParametricBrdf>(&fitted->body);
    const auto source = std::make_shared<const MaterialMeasurement>(make_reflecting_material(fitted, 0),
                                                                    parametric ? parametric->views : ViewRange{});
    *out = peer_job(source, checked_peer(peer));
  });
}

void vlr_microsurface_options_init(vlr_microsurface_options* options) {
  static const MicrosurfaceOptions defaults;  // immutable; lends its metal's name to every caller
  *options = {};
  options->struct_size = sizeof(vlr_microsurface_options);
  options->metal = defaults.metal.c_str();
  options->roughness = defaults.roughness;
  options->anisotropy = defaults.anisotropy;
  for (int i = 0; i < 3; ++i) options->base_albedo[i] = defaults.base_albedo[i];
  options->base_share = defaults.base_share;
  options->ior = defaults.ior;
  options->flake_roughness = defaults.flake_roughness;
  options->rays = defaults.rays;
}

vlr_status vlr_microsurface_create_job(const vlr_microsurface_options* options, const char* path, vlr_job** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    const auto given = read_options(options, vlr_microsurface_options_init, "vlr_microsurface_options");
    auto output = std::make_shared<JobOutput>();
    *out = new vlr_job(output, [output, capture = converted(given), target = std::string(path)](Progress& progress) {
      output->set(microsurface_json(capture_microsurface(capture, target, progress)));
    });
  });
}
