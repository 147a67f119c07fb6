// Fits the per-view univariate SRBF model to a measurement.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/fit_model.h"
#include "brdf/fit/per_view/slice_fit.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/model/per_view_brdf.h"
#include "model/records.h"

namespace velour {

// The fitted slices of all views, and the per-view model made of them, optionally within a bound in bytes.

// Number of lobes that each view may keep if the size of the model is bounded.

/// The greedy path of one view, and the importance of its error.
struct ViewPath {
  std::vector<SliceFit> path;
  double importance;  // cos(theta_v): the weight of the view in relative_l2
};

/// Number of lobes of each view, at most `lobes` in total. Lobes are removed where they lower the weighted sum of
/// squared errors least: the exact minimum if the squared errors along each path are convex, otherwise close to it.
std::vector<size_t> share_lobes(const std::vector<ViewPath>& views, uint64_t lobes);

/// Indices of `keep` of `count` views, evenly spread, including the first and last.
std::vector<size_t> thinned(size_t count, size_t keep);

/// Path i is the fit of slice i; only its last entry is in the model.
struct FittedSlices {
  std::vector<MeasuredSlice> slices;
  std::vector<ViewPath> paths;
};

/// Bytes of the parameters of assemble(fitted).
uint64_t parameter_bytes(const FittedSlices& fitted);

std::shared_ptr<PerViewBrdf> assemble(const FittedSlices& fitted, bool isotropic, const FitOptions& options);

/// Relative L2 error of `brdf` at the samples of `slices`, as a mean over the views weighted by cos(theta_v). At views
/// that the model does not have, this judges its interpolation.
double error_over_slices(std::shared_ptr<const PerViewBrdf> brdf, const std::vector<MeasuredSlice>& slices);

/// The subset of `all` whose parameters take at most `max_bytes` (at least those of one view without lobes) and whose
/// model is closest to the samples of all views. Several numbers of evenly spread views are tried, each with the lobes
/// that matter most.
FittedSlices within(uint64_t max_bytes, const FittedSlices& all, bool isotropic, const FitOptions& options);

/// Each view's slice of f cos(theta_l) is fitted by greedy insertion and joint refinement with non-negative
/// coefficients until the tolerance or the bound is reached. Deterministic for any thread count.
Model fit_per_view(const Measurement& measurement, const FitOptions& options, Progress& progress);

// The order curve of a per-view fit, from the greedy paths of its views, without refitting.

/// The points of `all` with at most 1, 2, 4, ... lobes per view, and that of `chosen`, the stored model. Errors are
/// those of the views at their own samples, without the interpolation between views.
OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance);

}  // namespace velour
