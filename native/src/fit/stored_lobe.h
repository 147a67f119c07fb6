// Between the solver's lobes and those of a model.
#pragma once

#include "fit/slice_solver.h"

namespace velour {

/// A lobe as ScatteredBrdf keeps it: coefficient times kernel_value(kernel, bandwidth, d).
struct StoredLobe {
  Vec3 center;
  float bandwidth;
  Rgb coefficient;
};

/// The solver's lobe in the model's terms; the coefficient belongs to the bandwidth as rounded to float.
StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe);

}  // namespace velour
