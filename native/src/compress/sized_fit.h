// A BTF fit at the requested size.
#pragma once

#include <functional>

#include "compress/btf_compare.h"
#include "compress/btf_fitter.h"
#include "compress/fit_checkpoint.h"

namespace velour {

struct SizedFit {
  ModelBody body;
  BtfErrors errors;
  OrderCurve order;               // scaled to the measured errors; the chosen point is the body's
  std::vector<SizeTrial> trials;  // the last one need not be the body
  std::string shortfall;          // one sentence if the tolerance is not met
  double seconds = 0;             // time of all fits, without measuring errors
};

/// Computes the errors of a model against the data to which it was fitted.
using ErrorsOf = std::function<BtfErrors(const ModelBody&, Progress&)>;

/// Requested tolerance, and where the errors of finished fits are stored.
struct SizedFitOptions {
  double tolerance = 0;
  FitCheckpoint& checkpoint;
};

/// Fits the largest model without a tolerance, otherwise the smallest one within it (size_search.h).
SizedFit fit_at_size(BtfFitter& fitter, const ErrorsOf& errors_of, const SizedFitOptions& options, Progress& progress);

}  // namespace velour
