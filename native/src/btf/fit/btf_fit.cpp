#include "btf/fit/btf_fit.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <string>
#include "base/error.h"
#include "btf/fit/btf_compare.h"
#include "btf/fit/size_search.h"
#include "btf/fit/srbf/srbf_fit.h"
#include "btf/fit/svd/svd_fit.h"
#include "btf/fit/tensor/tensor_fit.h"
#include "btf/measure/pair_layout.h"
#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "model/model.h"

namespace velour {

namespace {

constexpr double kSetup = 0.2, kFits = 0.97;  // where parts of the progress end

void require_same_texels(const TexelGrid& a, const TexelGrid& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw Error(Status::invalid_argument, "The BTF has " + std::to_string(a.width) + " x " + std::to_string(a.height) +
                                            " texels, but the BTF or model that it is compared with has " +
                                            std::to_string(b.width) + " x " + std::to_string(b.height) +
                                            "; both must have the same size.");
}

BtfErrors compare_body(const BtfMeasurement& truth, const ModelBody& body, double p99, int threads,
                       Progress& progress) {
  with_btf(body, [&](const auto& btf) { require_same_texels(truth.grid(), btf.grid); });
  const Companding companding = with_btf(body, [](const auto& btf) { return btf.companding; });
  return compare_btf(truth, images_of(body), {p99, companding}, threads, progress);
}

const char* name_of(CompressMethod method) {
  constexpr const char* kNames[] = {"svd", "srbf", "tucker", "cta", "kcta", "svd-view"};
  return kNames[static_cast<size_t>(method)];
}

/// Identifies the measurement and all that affects the bits of the fit. Whatever changes a fit's numbers must increment
/// kFitVersion.
std::string checkpoint_key(const BtfMeasurement& measurement, const CompressOptions& options) {
  constexpr int kFitVersion = 10;
  std::ostringstream key;
  key << kFitVersion << ' ' << measurement.provenance().sha256 << ' ' << measurement.raw_bytes() << ' '
      << name_of(options.method) << ' ' << static_cast<int>(options.companding) << ' ' << options.bytes << ' '
      << std::hexfloat << options.tolerance << ' ' << options.seed << ' ' << options.memory << ' ' << options.clusters
      << ' ' << options.members << ' ' << options.relief;
  for (const auto& [name, value] : measurement.details()) key << '\n' << name << '=' << value;
  return key.str();
}

/// f of a model with sides, without the data that a material prepares for sampling.
template <typename Evaluator>
BtfValue value_by(std::shared_ptr<const Evaluator> evaluator) {
  return [evaluator, point = std::make_shared<typename Evaluator::Point>()](const BtfQuery& query) {
    evaluator->begin(0, query.pair.wv, *point);
    evaluator->add(query.place, 0, 1, *point);
    evaluator->finish(*point);
    return evaluator->value(*point, query.pair.wl);
  };
}

/// f of a BTF's model.
BtfValue value_of(const std::shared_ptr<const Model>& model) {
  if (const auto* srbf = std::get_if<SrbfBtf>(&model->body)) {
    return value_by(std::make_shared<const SrbfEvaluator>(std::shared_ptr<const SrbfBtf>(model, srbf)));
  }
  if (const auto* tensors = std::get_if<TensorBtf>(&model->body)) {
    return value_by(std::make_shared<const TensorEvaluator>(std::shared_ptr<const TensorBtf>(model, tensors)));
  }
  return [material = make_material(model, 0), arena = std::make_shared<ScratchArena>()](const BtfQuery& query) {
    arena->reset();
    return material->prepare(query.pair.wv, {.uv = query.place}, {}, *arena)->eval_one(query.pair.wl).f;
  };
}

}  // namespace

Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  if (options.held_out) require_same_texels(options.held_out->grid(), measurement.grid());
  FitCheckpoint checkpoint({options.checkpoint, checkpoint_key(measurement, options), options.resume});
  BtfRecord record;
  const auto start = std::chrono::steady_clock::now();
  const auto fitter = [&] {
    const Progress::Span setup(progress, 0, kSetup);
    return make_fitter(measurement, options, checkpoint, progress);
  }();
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.p99 = percentile_99(measurement, progress);
  SizedFit found = [&] {
    const Progress::Span fits(progress, kSetup, kFits);
    const auto errors_of = [&](const ModelBody& body, Progress& p) {
      return compare_body(measurement, body, record.p99, options.threads, p);
    };
    return fit_at_size(*fitter, errors_of, {options.tolerance, checkpoint}, progress);
  }();
  record.seconds += found.seconds;
  const auto model = std::make_shared<Model>(Model{std::move(found.body), {}, {}});
  record.method = name_of(options.method);
  record.seed = options.seed;
  record.raw_bytes = measurement.raw_bytes();
  if (fitter->not_finite() > 0) {
    record.warnings.push_back(warning<WarningCode::values_not_finite>({{"values", fitter->not_finite()}}));
  }
  if (const auto repeated = repeated_directions(measurement.layout())) record.warnings.push_back(*repeated);
  for (const auto& found_by : {measurement.warnings(), fitter->warnings(), checkpoint.warnings()}) {
    record.warnings.insert(record.warnings.end(), found_by.begin(), found_by.end());
  }
  if (found.shortfall) record.warnings.push_back(*found.shortfall);
  record.psnr = found.errors.psnr;
  record.ser = found.errors.ser;
  record.relative_l2 = found.errors.relative_l2;
  record.tolerance = options.tolerance;
  record.order = std::move(found.order);
  record.search = std::move(found.trials);
  record.shapes = fitter->shapes();
  progress.stage("measuring held-out pairs", kFits, 1.0);
  if (options.held_out) {
    record.psnr_held_out = compare_body(*options.held_out, model->body, record.p99, options.threads, progress).psnr;
  }
  record.evaluations_per_second = evaluation_rate(value_of(model));
  const Provenance& source = measurement.provenance();
  model->source = {source.name, source.format, source.sha256};
  model->btf = std::move(record);
  progress.update(1.0);
  return std::move(*model);
}

BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, Progress& progress) {
  return compare_body(truth, model.body, model.btf.value().p99, threads, progress);
}

BtfErrors compare_with_table(const BtfMeasurement& truth, const BtfMeasurement& table, double p99, int threads,
                             Progress& progress) {
  require_same_texels(truth.grid(), table.grid());
  const PairInterpolation between(table.layout());
  const auto image = [&](const DirectionPair& pair, std::vector<float>& rgb) {
    rgb.assign(table.grid().texels() * 3, 0.0f);
    const auto view = between.view(pair.wv), light = between.light(pair.wl);
    if (!view || !light) return;
    std::vector<HalfBits> halves(rgb.size());
    std::vector<float> corner(rgb.size());
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = view->weight[v] * light->weight[l];
        if (weight == 0) continue;
        table.read_pairs(table.layout().first(view->index[v]) + light->index[l], 1, halves);
        halves_to_floats(halves, corner);
        mend_image(corner);
        for (size_t i = 0; i < rgb.size(); ++i) rgb[i] += weight * corner[i];
      }
    }
  };
  return compare_btf(truth, image, {.p99 = p99}, threads, progress);
}

namespace {

constexpr uint32_t kMaxClusters = 64, kMaxMembers = 4;  // limits of the search

/// Throws Error(invalid_argument) for numbers that the method does not support.
ShapeRange shapes_of(const CompressOptions& options) {
  ShapeRange range;
  if (options.method != CompressMethod::tucker) range.most_clusters = kMaxClusters;
  if (options.method == CompressMethod::kcta) range.most_members = kMaxMembers;
  if (options.clusters > 0) {
    if (options.method == CompressMethod::tucker && options.clusters > 1) {
      throw Error(Status::invalid_argument, "The method tucker has one cluster, not " +
                                                std::to_string(options.clusters) + "; use cta or kcta for more.");
    }
    if (options.clusters > TensorBtf::kMaxClusters) {
      throw Error(Status::invalid_argument, std::to_string(options.clusters) + " clusters are too many; at most " +
                                                std::to_string(TensorBtf::kMaxClusters) + " are supported.");
    }
    range.least_clusters = range.most_clusters = options.clusters;
  }
  if (options.members > 0) {
    const size_t most = options.method == CompressMethod::kcta ? TensorBtf::kMaxMembers : 1;
    if (options.members > most || (options.clusters > 0 && options.members > options.clusters)) {
      throw Error(Status::invalid_argument,
                  std::to_string(options.members) + " clusters per texel (members) are too many; " +
                      (most == 1 ? std::string("only the method kcta supports more than one.")
                                 : "at most " + std::to_string(most) +
                                       " are supported, and not more than the number of clusters."));
    }
    range.least_members = range.most_members = options.members;
    range.least_clusters = std::max(range.least_clusters, options.members);
  }
  return range;
}

bool has_tensors(CompressMethod method) {
  return method == CompressMethod::tucker || method == CompressMethod::cta || method == CompressMethod::kcta;
}

}  // namespace

FitSize fit_size(const BtfMeasurement& measurement, const CompressOptions& options) {
  if (has_tensors(options.method)) return tensor_fit_size(measurement, options);
  if (options.method == CompressMethod::srbf) return srbf_fit_size(measurement, options);
  return factored_fit_size(measurement, options, options.method == CompressMethod::svd_view);
}

std::unique_ptr<BtfFitter> make_fitter(const BtfMeasurement& measurement, const CompressOptions& options,
                                       FitCheckpoint& checkpoint, Progress& progress) {
  const bool tensors = has_tensors(options.method);
  if (!tensors && (options.clusters > 0 || options.members > 0)) {
    throw Error(Status::invalid_argument,
                "Clusters and members are only available with the methods tucker, cta and kcta.");
  }
  if (!tensors && options.method != CompressMethod::srbf && !options.relief) {
    throw Error(Status::invalid_argument,
                "Only the methods srbf, tucker, cta and kcta fit a relief that can be omitted.");
  }
  if (tensors) return std::make_unique<TensorFitter>(measurement, options, shapes_of(options), checkpoint, progress);
  if (options.method == CompressMethod::svd) {
    return std::make_unique<SvdFitter>(measurement, options, checkpoint, progress);
  }
  if (options.method == CompressMethod::svd_view) {
    return std::make_unique<ViewSvdFitter>(measurement, options, checkpoint, progress);
  }
  return std::make_unique<SrbfFitter>(measurement, options, checkpoint, progress);
}

std::vector<BtfQuery> random_queries() {
  constexpr uint32_t kQueries = 20000;
  std::vector<BtfQuery> queries;
  for (uint32_t i = 0; i < kQueries; ++i) {
    RandomStream random(0, i, 0);
    BtfQuery& query = queries.emplace_back();
    query.place = random.next2();
    query.pair = {sample_cosine_hemisphere(random.next2()), sample_cosine_hemisphere(random.next2())};
  }
  return queries;
}

double evaluation_rate(const BtfValue& value) { return 1 / seconds_a_query(random_queries(), value); }

}  // namespace velour
