// Fits a parametric model to the slices of a measurement: growth, refinement, rounding.
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/model/parametric_brdf.h"
#include "model/records.h"

namespace velour {

struct GrowthOptions {
  bool isotropic = true;
  int cells = 10;
  ViewRange views;
  int max_lobes = 12;
  double tolerance = 0.02;  // relative L2 of every view up to 75 degrees; twice that beyond
  bool seen_evenly = true;  // sample weights are solid angles alone (brdf/fit/parametric/solver.h)
  int threads = 0;
};

struct GrowthResult {
  ParametricBrdf brdf;  // control values are half floats
  std::vector<Vec3d> views;
  std::vector<double> error;  // relative L2 of each view, channels weighted as in luminance
  OrderCurve order;           // the growth, then the final model
};

/// Fits with increasing numbers of lobes that share their growth. Each equals grow_lobes() with that maximum.
class LobeGrowth {
 public:
  /// options.max_lobes only scales the progress.
  LobeGrowth(const std::vector<MeasuredSlice>& slices, const GrowthOptions& options, Progress& progress);
  ~LobeGrowth();

  /// Fit with at most `most` lobes, which must not decrease from call to call.
  GrowthResult fit(int most);
  /// In place of fit(): begins with the lobes of `coarse`, at least one, whose splines have half of options.cells.
  GrowthResult finer(const ParametricBrdf& coarse);

 private:
  class Growth;
  struct State;
  std::unique_ptr<State> state_;
};

GrowthResult grow_lobes(const std::vector<MeasuredSlice>& slices, const GrowthOptions& options, Progress& progress);
/// Continues from the lobes of `coarse` with splines twice as fine, whatever options.cells is.
GrowthResult grow_finer(const std::vector<MeasuredSlice>& slices, GrowthOptions options, const ParametricBrdf& coarse,
                        Progress& progress);

/// Recomputes the errors of `fit` after a change of its model.
void judge_again(const std::vector<MeasuredSlice>& slices, GrowthOptions options, GrowthResult& fit,
                 const Progress& progress);

}  // namespace velour
