// The fitted slices of all views: from greedy paths to a model, whole or within a bound in bytes.
#pragma once

#include <memory>
#include <vector>

#include "brdf/scattered_brdf.h"
#include "fit/fit_options.h"
#include "fit/lobe_budget.h"
#include "fit/slice_sampling.h"

namespace velour {

/// Slice i was fitted by path i; only the last fit of a path is in the model.
struct FittedSlices {
  std::vector<MeasuredSlice> slices;
  std::vector<ViewPath> paths;
};

/// Bytes of the parameters of assemble(fitted).
uint64_t parameter_bytes(const FittedSlices& fitted);

std::shared_ptr<ScatteredBrdf> assemble(const FittedSlices& fitted, bool isotropic, const FitOptions& options);

/// Relative L2 of `brdf` at the samples of `slices`, as a mean over the views weighted by cos(theta_v). The model need
/// not have these views: then its interpolation is what is judged.
double error_over_slices(std::shared_ptr<const ScatteredBrdf> brdf, const std::vector<MeasuredSlice>& slices);

/// The part of `all` whose parameters take at most `max_bytes` (at least those of one view without lobes) and whose
/// model comes closest to the samples of all views: several numbers of views are tried, evenly spread, each with the
/// lobes that matter most.
FittedSlices within(uint64_t max_bytes, const FittedSlices& all, bool isotropic, const FitOptions& options);

}  // namespace velour
