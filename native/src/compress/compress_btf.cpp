#include "compress/compress_btf.h"

#include <chrono>
#include <string>

#include "job/error.h"

namespace velour {
namespace {

BtfErrors compare_with_body(const BtfMeasurement& truth, const FactoredBtf& btf, double p99, int threads,
                            const Progress& progress) {
  if (truth.grid().width != btf.grid.width || truth.grid().height != btf.grid.height) {
    throw Error(Status::invalid_argument, "The BTF has " + std::to_string(truth.grid().width) + " x " +
                                              std::to_string(truth.grid().height) + " texels, the model " +
                                              std::to_string(btf.grid.width) + " x " + std::to_string(btf.grid.height) +
                                              "; they cannot be compared.");
  }
  const FactoredImages images(btf);
  const auto image = [&](const DirectionPair& pair, std::vector<float>& rgb) { images.image(pair, rgb); };
  return compare_btf(truth, image, p99, threads, progress);
}

}  // namespace

Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
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
  progress.stage("errors", 0.9, 1.0);
  record.p99 = percentile_99(measurement, progress);
  const BtfErrors fitted = compare_with_body(measurement, fit.btf, record.p99, options.threads, progress);
  record.psnr = fitted.psnr;
  record.ser = fitted.ser;
  if (options.held_out) {
    const BtfErrors unseen = compare_with_body(*options.held_out, fit.btf, record.p99, options.threads, progress);
    record.psnr_held_out = unseen.psnr;
  }
  Model model{std::move(fit.btf), {}, {}};
  const Provenance& source = measurement.provenance();
  model.source = {source.name, source.format, source.sha256};
  model.btf = std::move(record);
  return model;
}

BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, const Progress& progress) {
  return compare_with_body(truth, std::get<FactoredBtf>(model.body), model.btf.value().p99, threads, progress);
}

}  // namespace velour
