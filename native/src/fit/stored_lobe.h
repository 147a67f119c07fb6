// Converts the solver's lobes to those of a model.
#pragma once

#include "fit/slice_solver.h"

namespace velour {

/// A lobe as ScatteredBrdf stores it: coefficient times kernel_value(kernel, bandwidth, d).
struct StoredLobe {
  Vec3 center;
  float bandwidth;
  Rgb coefficient;
};

/// Converts a lobe of the solver; the coefficient is for the bandwidth rounded to float.
StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe);

}  // namespace velour
