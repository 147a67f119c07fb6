// A fit of a BTF at the size that its options ask for.
#pragma once

#include <functional>

#include "compress/btf_compare.h"
#include "compress/btf_fitter.h"
#include "compress/fit_checkpoint.h"

namespace velour {

struct SizedFit {
  ModelBody body;
  BtfErrors errors;
  OrderCurve order;               // measured at the trials' heights; the chosen point is the body's
  std::vector<SizeTrial> trials;  // of which the last need not be the body
  std::string shortfall;          // a sentence where a tolerance is not met
  double seconds = 0;             // of all fits, without measuring
};

/// Errors of a model against what it was fitted to.
using ErrorsOf = std::function<BtfErrors(const ModelBody&, Progress&)>;

/// What is asked of the size, and where finished fits are kept.
struct SizedFitOptions {
  double tolerance = 0;
  FitCheckpoint& checkpoint;
};

/// Without a tolerance the largest model; with one the smallest that is within it (size_search.h).
SizedFit fit_at_size(BtfFitter& fitter, const ErrorsOf& errors_of, const SizedFitOptions& options, Progress& progress);

}  // namespace velour
