#include "compress/compress_btf.h"

#include <chrono>
#include <string>

#include "btf/pair_interpolation.h"
#include "job/error.h"

namespace velour {
namespace {

void require_same_texels(const TexelGrid& a, const TexelGrid& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw Error(Status::invalid_argument, "The BTF has " + std::to_string(a.width) + " x " + std::to_string(a.height) +
                                            " texels, what it is compared with " + std::to_string(b.width) + " x " +
                                            std::to_string(b.height) + "; they must be the same.");
}

BtfErrors compare_with_body(const BtfMeasurement& truth, const FactoredBtf& btf, double p99, int threads,
                            Progress& progress) {
  require_same_texels(truth.grid(), btf.grid);
  const FactoredImages images(btf);
  const auto image = [&](const DirectionPair& pair, std::vector<float>& rgb) { images.image(pair, rgb); };
  return compare_btf(truth, image, p99, threads, progress);
}

}  // namespace

Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  if (options.held_out) require_same_texels(options.held_out->grid(), measurement.grid());
  const auto start = std::chrono::steady_clock::now();
  SvdFit fit = fit_svd(measurement, options, progress);
  BtfRecord record;
  record.method = "svd";
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.seed = options.seed;
  record.raw_bytes = measurement.raw_bytes();
  if (fit.not_finite > 0) {
    record.warnings.push_back(std::to_string(fit.not_finite) +
                              " entries of the BTF are not finite; the mean of their image stands in for them.");
  }
  progress.stage("errors", 0.55, 0.95);
  record.p99 = percentile_99(measurement, progress);
  const BtfErrors fitted = compare_with_body(measurement, fit.btf, record.p99, options.threads, progress);
  record.psnr = fitted.psnr;
  record.ser = fitted.ser;
  if (options.held_out) {
    progress.stage("unseen pairs", 0.95, 1.0);
    const BtfErrors unseen = compare_with_body(*options.held_out, fit.btf, record.p99, options.threads, progress);
    record.psnr_held_out = unseen.psnr;
  }
  Model model{std::move(fit.btf), {}, {}};
  const Provenance& source = measurement.provenance();
  model.source = {source.name, source.format, source.sha256};
  model.btf = std::move(record);
  return model;
}

BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, Progress& progress) {
  return compare_with_body(truth, std::get<FactoredBtf>(model.body), model.btf.value().p99, threads, progress);
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
