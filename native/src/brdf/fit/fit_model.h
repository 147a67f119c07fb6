// Fits a measurement with any kind of model. The only place that knows all fits.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "model/model.h"
#include "usage/observation.h"

namespace velour {

// Options of the fits of all model kinds.

struct FitOptions {
  Kernel kernel = Kernel::gaussian;
  double tolerance = 0.02;  // relative L2 of every view up to 75 degrees; twice that beyond
  int max_lobes = 16;       // per-view model: per view; parametric: in total
  uint64_t max_bytes = 0;   // upper bound of `size_of`; 0: none
  uint64_t seed = 0;
  int threads = 0;            // 0: all
  bool all_data = false;      // hold out no data
  bool align_views = true;    // per-view model only
  bool symmetric = false;     // parametric: make it reciprocal, which at least doubles the cost of an evaluation
  bool limit_albedo = false;  // parametric: limit the directional albedo to 1 (brdf/fit/error/evaluate.h)
  /// Scene usage that the model is reduced to (brdf/fit/scene_fit.h). Null: the model is for any scene.
  std::shared_ptr<const SceneObservation> for_scene;
  /// With for_scene: the parametric model for any scene. Null: it is fitted first.
  std::shared_ptr<const Model> full_model;
  /// Bytes that max_bytes bounds, such as the size of the model's file, which the fit does not know. Empty:
  /// parameter_bytes.
  std::function<uint64_t(const Model&)> size_of;
  /// The verdict on a model (verdict/verdict.h), which decides between kinds; its reason is not needed. Empty:
  /// their errors alone do.
  std::function<std::optional<Verdict>(const Model&, Progress&)> verdict_on;
};

/// The values are those of VLR_MODEL_*.
enum class ModelKind { per_view = 0, parametric = 1, automatic = 2 };

constexpr ModelKind kDefaultModelKind = ModelKind::automatic;

/// options.max_bytes bounds models of either kind; a parametric one is refitted with fewer lobes until it is met.
///
/// Automatic: parametric, unless a reported view misses its tolerance several times over or the verdict is not good.
/// Then the fit continues with splines twice as fine, and if that does not help, a per-view model follows. A larger
/// model must have a better verdict, or the same one and errors lower by a third or FLIP by a fifth; one of a table may
/// not have errors higher by half. Options that only one kind has, and bounds of the size, decide by themselves.
Model fit_model(ModelKind kind, const Measurement& measurement, const FitOptions& options, Progress& progress);

}  // namespace velour
