// Options of the fits of all model kinds.
#pragma once

#include <functional>
#include <memory>

#include "brdf/measure/measurement.h"
#include "model/model.h"
#include "usage/observation.h"

namespace velour {

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
  bool limit_albedo = false;  // parametric: limit the directional albedo to 1 (brdf/fit/error/albedo.h)
  /// Scene usage that the model is reduced to (brdf/fit/scene_fit.h). Null: the model is for any scene.
  std::shared_ptr<const SceneObservation> for_scene;
  /// With for_scene: the parametric model for any scene. Null: it is fitted first.
  std::shared_ptr<const Model> full_model;
  /// Bytes that max_bytes bounds, such as the size of the model's file, which the fit does not know. Empty:
  /// parameter_bytes.
  std::function<uint64_t(const Model&)> size_of;
};

}  // namespace velour
