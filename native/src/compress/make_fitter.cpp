#include "compress/make_fitter.h"

#include <algorithm>
#include <string>

#include "compress/srbf_fit.h"
#include "compress/svd_fit.h"
#include "compress/tensor_fit.h"
#include "compress/view_svd_fit.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint32_t kMostClusters = 64, kMostMembers = 4;  // limits of the search

/// Throws Error(invalid_argument) for numbers that the method does not support.
ShapeRange shapes_of(const CompressOptions& options) {
  ShapeRange range;
  if (options.method != CompressMethod::tucker) range.most_clusters = kMostClusters;
  if (options.method == CompressMethod::kcta) range.most_members = kMostMembers;
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

}  // namespace velour
