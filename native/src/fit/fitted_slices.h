// The fitted slices of all views, and the per-view model made of them, optionally within a bound in bytes.
#pragma once

#include <memory>
#include <vector>

#include "brdf/scattered_brdf.h"
#include "fit/fit_options.h"
#include "fit/lobe_budget.h"
#include "fit/slice_sampling.h"

namespace velour {

/// Path i is the fit of slice i; only its last entry is in the model.
struct FittedSlices {
  std::vector<MeasuredSlice> slices;
  std::vector<ViewPath> paths;
};

/// Bytes of the parameters of assemble(fitted).
uint64_t parameter_bytes(const FittedSlices& fitted);

std::shared_ptr<ScatteredBrdf> assemble(const FittedSlices& fitted, bool isotropic, const FitOptions& options);

/// Relative L2 error of `brdf` at the samples of `slices`, as a mean over the views weighted by cos(theta_v). At views
/// that the model does not have, this judges its interpolation.
double error_over_slices(std::shared_ptr<const ScatteredBrdf> brdf, const std::vector<MeasuredSlice>& slices);

/// The subset of `all` whose parameters take at most `max_bytes` (at least those of one view without lobes) and whose
/// model is closest to the samples of all views. Several numbers of evenly spread views are tried, each with the lobes
/// that matter most.
FittedSlices within(uint64_t max_bytes, const FittedSlices& all, bool isotropic, const FitOptions& options);

}  // namespace velour
