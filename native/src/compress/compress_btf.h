// From a BTF to its model.
#pragma once

#include <memory>

#include "compress/btf_compare.h"
#include "compress/btf_fit_options.h"
#include "domain/observation.h"
#include "model/model.h"

namespace velour {

enum class CompressMethod : uint8_t { svd = 0, srbf = 1, tucker = 2, cta = 3, kcta = 4, svd_view = 5 };

struct CompressOptions : BtfFitOptions {
  CompressMethod method = CompressMethod::srbf;
  std::string checkpoint;  // a file that finished stages are kept in until the fit has succeeded; empty: none
  bool resume = false;     // what it holds is not done again
  std::shared_ptr<const BtfMeasurement> held_out;  // pairs that no fit has seen; null: none
  /// Leave out what these scenes do not resolve (scene_reduction.h); null: the model serves any scene.
  std::shared_ptr<const SceneObservation> for_scene;
  std::shared_ptr<const Model> full_model;  // with for_scene: what is reduced; null: it is fitted first
};

/// A model with its errors, for any scene: whatever options.for_scene is. Throws Error(invalid_argument) when
/// `held_out` has other texels.
Model compress_btf(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

/// Errors of a BTF's model against the pairs of `truth`; white is the model's own. Throws Error(invalid_argument) when
/// the texels differ.
BtfErrors compare_with_model(const BtfMeasurement& truth, const Model& model, int threads, Progress& progress);

/// The same of another BTF, interpolated in f between its own pairs: what no model of it needs to beat.
BtfErrors compare_with_table(const BtfMeasurement& truth, const BtfMeasurement& table, double p99, int threads,
                             Progress& progress);

}  // namespace velour
