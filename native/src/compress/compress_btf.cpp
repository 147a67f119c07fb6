#include "compress/compress_btf.h"

#include <chrono>
#include <string>

#include "btf/pair_interpolation.h"
#include "btf/srbf_evaluator.h"
#include "compress/evaluation_rate.h"
#include "job/error.h"
#include "model/model_material.h"

namespace velour {
namespace {

void require_same_texels(const TexelGrid& a, const TexelGrid& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw Error(Status::invalid_argument, "The BTF has " + std::to_string(a.width) + " x " + std::to_string(a.height) +
                                            " texels, what it is compared with " + std::to_string(b.width) + " x " +
                                            std::to_string(b.height) + "; they must be the same.");
}

/// The images of a model of a BTF.
class ModelImages {
 public:
  explicit ModelImages(const ModelBody& body) {
    if (const auto* factored = std::get_if<FactoredBtf>(&body)) {
      grid_ = factored->grid;
      images_ = [images = std::make_shared<FactoredImages>(*factored)](
                    const DirectionPair& pair, std::vector<float>& rgb) { images->image(pair, rgb); };
    } else {
      const auto& srbf = std::get<SrbfBtf>(body);
      grid_ = srbf.grid;
      images_ = [evaluator = std::make_shared<SrbfEvaluator>(unowned(srbf))](
                    const DirectionPair& pair, std::vector<float>& rgb) { srbf_image(*evaluator, pair, rgb); };
    }
  }

  BtfErrors compare(const BtfMeasurement& truth, double p99, int threads, Progress& progress) const {
    require_same_texels(truth.grid(), grid_);
    return compare_btf(truth, images_, p99, threads, progress);
  }

 private:
  /// The body outlives the images.
  static std::shared_ptr<const SrbfBtf> unowned(const SrbfBtf& btf) { return {std::shared_ptr<const void>(), &btf}; }

  TexelGrid grid_;
  BtfImages images_;
};

/// The body of a model and how many entries were left out.
std::pair<ModelBody, uint64_t> fitted(const BtfMeasurement& measurement, const CompressOptions& options,
                                      Progress& progress) {
  if (options.method == CompressMethod::svd) {
    SvdFit fit = fit_svd(measurement, options, progress);
    return {std::move(fit.btf), fit.not_finite};
  }
  SrbfFit fit = fit_srbf(measurement, options, progress);
  return {std::move(fit.btf), fit.not_finite};
}

/// f of a model of a BTF.
BtfValue value_of(const std::shared_ptr<const Model>& model) {
  if (const auto* srbf = std::get_if<SrbfBtf>(&model->body)) {
    const auto evaluator = std::make_shared<SrbfEvaluator>(std::shared_ptr<const SrbfBtf>(model, srbf));
    return [evaluator, point = std::make_shared<SrbfPoint>()](const Vec2& place, const DirectionPair& pair) {
      evaluator->begin(0, pair.wv, *point);
      evaluator->add(place, 0, 1, *point);
      evaluator->finish(*point);
      return evaluator->value(*point, pair.wl);
    };
  }
  return [material = make_material(model, 0), point = std::make_shared<PreparedBrdf>()](const Vec2& place,
                                                                                        const DirectionPair& pair) {
    material->prepare(pair.wv, {.uv = place}, *point);
    return material->eval_one(*point, pair.wl).f;
  };
}

const char* name_of(CompressMethod method) { return method == CompressMethod::svd ? "svd" : "srbf"; }

}  // namespace

Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  if (options.held_out) require_same_texels(options.held_out->grid(), measurement.grid());
  const auto start = std::chrono::steady_clock::now();
  auto [body, not_finite] = fitted(measurement, options, progress);
  const auto model = std::make_shared<Model>(Model{std::move(body), {}, {}});
  BtfRecord record;
  record.method = name_of(options.method);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.seed = options.seed;
  record.raw_bytes = measurement.raw_bytes();
  if (not_finite > 0) {
    record.warnings.push_back(std::to_string(not_finite) +
                              " entries of the BTF are not finite; the mean of their image stands in for them.");
  }
  progress.stage("errors", 0.8, 0.97);
  record.p99 = percentile_99(measurement, progress);
  const ModelImages images(model->body);
  const BtfErrors errors = images.compare(measurement, record.p99, options.threads, progress);
  record.psnr = errors.psnr;
  record.ser = errors.ser;
  if (options.held_out) {
    progress.stage("unseen pairs", 0.97, 1.0);
    record.psnr_held_out = images.compare(*options.held_out, record.p99, options.threads, progress).psnr;
  }
  record.evaluations_per_second = evaluation_rate(value_of(model));
  const Provenance& source = measurement.provenance();
  model->source = {source.name, source.format, source.sha256};
  model->btf = std::move(record);
  return std::move(*model);
}

BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, Progress& progress) {
  return ModelImages(model.body).compare(truth, model.btf.value().p99, threads, progress);
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
        for (size_t i = 0; i < rgb.size(); ++i) rgb[i] += weight * corner[i];
      }
    }
  };
  return compare_btf(truth, image, p99, threads, progress);
}

}  // namespace velour
