// From the slices of a measurement to a parametric model: growth, refinement, rounding.
#pragma once

#include <memory>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "fit/slice_sampling.h"
#include "job/progress.h"
#include "model/order_curve.h"

namespace velour {

struct TrackedFitOptions {
  bool isotropic = true;
  int cells = 10;
  ViewRange views;
  int max_lobes = 12;
  double tolerance = 0.02;  // relative L2 of every view up to 75 degrees; twice that beyond
  bool seen_evenly = true;  // samples weigh their solid angle alone (fit/tracked_problem.h)
  int threads = 0;
};

struct TrackedFit {
  ParametricBrdf brdf;  // control values are half floats
  std::vector<Vec3d> views;
  std::vector<double> error;  // relative L2 of each view, channels weighted as in luminance
  OrderCurve order;           // the growth, and what it became
};

/// Fits with more and more lobes that share their growth: each is what fit_tracked() makes with that many at most.
class TrackedGrowth {
 public:
  /// Of `options`, max_lobes only scales the progress.
  TrackedGrowth(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options, Progress& progress);
  ~TrackedGrowth();

  /// With at most `most` lobes, no fewer than were asked for before.
  TrackedFit fit(int most);

 private:
  class Growth;
  struct State;
  std::unique_ptr<State> state_;
};

TrackedFit fit_tracked(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options, Progress& progress);

/// Takes the errors of `fit` anew, after its model was changed.
void judge_again(const std::vector<MeasuredSlice>& slices, TrackedFitOptions options, TrackedFit& fit,
                 const Progress& progress);

}  // namespace velour
