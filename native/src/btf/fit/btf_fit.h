// Compression of a BTF to a model.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <vector>
#include "base/process.h"
#include "btf/fit/btf_compare.h"
#include "btf/fit/btf_fitter.h"
#include "btf/fit/fit_checkpoint.h"
#include "math/sphere/vec.h"
#include "model/model.h"
#include "usage/observation.h"

namespace velour {

enum class CompressMethod : uint8_t { svd = 0, srbf = 1, tucker = 2, cta = 3, kcta = 4, svd_view = 5 };

struct CompressOptions : BtfFitOptions {
  CompressMethod method = CompressMethod::srbf;
  std::string checkpoint;                          // file for finished stages, deleted by the caller; empty: none
  bool resume = false;                             // reuse the stages in the checkpoint
  std::shared_ptr<const BtfMeasurement> held_out;  // held-out pairs for validation; null: none
  /// Scene usage to which the model is reduced (scene_reduction.h); null: the model serves any scene.
  std::shared_ptr<const SceneObservation> for_scene;
  std::shared_ptr<const Model> full_model;  // with for_scene: the model to reduce; null: it is fitted first
};

/// Fits a model for any scene, whatever options.for_scene is, and measures its errors. Throws Error(invalid_argument)
/// if `held_out` has other texels.
Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

/// Errors of a BTF's model on the pairs of `truth`, with the model's own white point. Throws Error(invalid_argument) if
/// the texels differ.
BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, Progress& progress);

/// Errors of another BTF, with f interpolated between its own pairs: a bound that no model of it needs to beat.
BtfErrors compare_with_table(const BtfMeasurement& truth, const BtfMeasurement& table, double p99, int threads,
                             Progress& progress);

// Creates BTF fitters by method.

/// The arguments must outlive the fitter. Throws the errors of the fitters, and Error(invalid_argument) for clusters,
/// members or no relief where the method does not support them.
std::unique_ptr<BtfFitter> make_fitter(const BtfMeasurement& measurement, const CompressOptions& options,
                                       FitCheckpoint& checkpoint, Progress& progress);

/// Estimated requirements of such a fit; reads no data. Throws Error(unsupported) for an incomplete layout.
FitSize fit_size(const BtfMeasurement& measurement, const CompressOptions& options);

// Speed of BTF evaluation.

struct BtfQuery {
  Vec2 place;  // in tiles
  DirectionPair pair;
};
/// 20,000 queries with random places, views and lights (sampled by the cosine).
std::vector<BtfQuery> random_queries();

/// CPU seconds of `use` per query: the minimum of seven runs, since other programs can only slow a run down.
template <class Use>
double seconds_a_query(const std::vector<BtfQuery>& queries, const Use& use) {
  constexpr int kRuns = 7;
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const double start = thread_seconds();
    for (const BtfQuery& query : queries) {
      const auto result = use(query);
      asm volatile("" : : "r"(&result) : "memory");  // keeps the work from being optimized away
    }
    least = std::min(least, thread_seconds() - start);
  }
  return least / static_cast<double>(queries.size());
}

/// f of a query, without a footprint.
using BtfValue = std::function<Rgb(const BtfQuery& query)>;

/// Evaluations per second of CPU time on one thread.
double evaluation_rate(const BtfValue& value);

}  // namespace velour
