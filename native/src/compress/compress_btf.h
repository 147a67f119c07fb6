// Compression of a BTF to a model.
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
  std::string checkpoint;                          // stores finished stages until the fit has succeeded; empty: none
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

}  // namespace velour
