// Greedy fit of one slice: adds one lobe at a time until the goal or the bound is reached.
#pragma once

#include <vector>
#include "brdf/fit/per_view/slice_solver.h"

namespace velour {

struct SliceFitOptions {
  Kernel kernel = Kernel::gaussian;
  int max_lobes = 16;
  double goal = 0.02;  // relative L2 of the luminance at which no more lobes are added
};

/// The lobes and the cosine term of a slice, and their luminance error over the fitted samples.
struct SliceFit {
  std::vector<SliceLobe> lobes;
  Vec3d diffuse{0, 0, 0};
  double relative_l2 = 1;
};

/// The path of the greedy fit: entry J is the best fit found with at most J lobes (entry 0 has none), and the errors
/// never rise along it. The last entry is the fit.
std::vector<SliceFit> fit_slice(const SliceSamples& samples, const SliceFitOptions& options, const Progress& progress);

// Converts the solver's lobes to those of a model.

/// A lobe as PerViewBrdf stores it: coefficient times kernel_value(kernel, bandwidth, d).
struct StoredLobe {
  Vec3 center;
  float bandwidth;
  Rgb coefficient;
};

/// Converts a lobe of the solver; the coefficient is for the bandwidth rounded to float.
StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe);

}  // namespace velour
