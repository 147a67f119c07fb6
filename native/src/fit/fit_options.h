// What a fit is asked for, whatever its model.
#pragma once

#include <functional>

#include "brdf/measurement.h"
#include "model/model.h"

namespace velour {

struct FitOptions {
  Kernel kernel = Kernel::gaussian;
  double tolerance = 0.02;  // relative L2 of every view up to 75 degrees; twice that beyond
  int max_lobes = 16;       // scattered: a view; parametric: in all
  uint64_t max_bytes = 0;   // of what `size_of` measures; 0: no bound
  uint64_t seed = 0;
  int threads = 0;          // 0: all
  bool all_data = false;    // hold nothing out
  bool align_views = true;  // scattered alone
  /// Bytes of a model as its user counts them: of its file, say, which the fit knows nothing of. Empty:
  /// parameter_bytes.
  std::function<uint64_t(const Model&)> size_of;
};

}  // namespace velour
