// What a fit is asked for, whatever its model.
#pragma once

#include <functional>
#include <memory>

#include "brdf/measurement.h"
#include "domain/observation.h"
#include "model/model.h"

namespace velour {

struct FitOptions {
  Kernel kernel = Kernel::gaussian;
  double tolerance = 0.02;  // relative L2 of every view up to 75 degrees; twice that beyond
  int max_lobes = 16;       // scattered: a view; parametric: in all
  uint64_t max_bytes = 0;   // of what `size_of` measures; 0: no bound
  uint64_t seed = 0;
  int threads = 0;            // 0: all
  bool all_data = false;      // hold nothing out
  bool align_views = true;    // scattered alone
  bool symmetric = false;     // parametric: made reciprocal, at twice the cost of an evaluation and more
  bool limit_albedo = false;  // parametric: lowered where more light would leave than arrives (fit/albedo_limit.h)
  /// What scenes show of the material: the model is reduced to it (fit/scene_fit.h). Null: the model is for any scene.
  std::shared_ptr<const SceneObservation> for_scene;
  /// With for_scene: the parametric model that serves any scene; null: it is fitted first.
  std::shared_ptr<const Model> full_model;
  /// Bytes of a model as its user counts them: of its file, say, which the fit knows nothing of. Empty:
  /// parameter_bytes.
  std::function<uint64_t(const Model&)> size_of;
};

}  // namespace velour
