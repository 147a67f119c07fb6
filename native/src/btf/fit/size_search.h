// Search for the model size that has a requested error.
#pragma once

#include <functional>
#include <optional>
#include "btf/fit/btf_compare.h"
#include "btf/fit/btf_fitter.h"
#include "btf/fit/fit_checkpoint.h"
#include "model/records.h"

namespace velour {

/// Finds the smallest model within a tolerance with few fits. A curve known in advance gives the shape of error over
/// size; each measured fit gives its height at that size. Between fits on both sides of the tolerance, the height is
/// interpolated in logarithms.
class SizeSearch {
 public:
  /// `curve`: expected errors; points beyond `largest` are never requested. `tolerance` 0: only the largest.
  SizeSearch(const OrderCurve& curve, size_t largest, double tolerance);

  /// The point to fit next; empty when the search is over.
  std::optional<size_t> next() const;
  void add(size_t point, double error);

  /// The result among the points fitted: the smallest within the tolerance, otherwise the one with the smallest error.
  size_t best() const;
  bool met() const;
  /// In the order of the fits.
  std::vector<SizeTrial> trials() const;

  /// The curve scaled to the measured heights, with best() as the chosen point: at most `most` points, evenly spaced by
  /// logarithm, and all points fitted.
  OrderCurve measured_curve(size_t most) const;
  /// By how much the tolerance is missed, and what would suffice.
  Warning shortfall() const;

 private:
  struct Fit {
    size_t point;
    double error;
  };
  bool holds(const Fit& fit) const { return fit.error <= tolerance_; }
  bool was_fitted(size_t point) const;
  const Fit& best_fit() const;
  std::optional<Fit> largest_failing() const;
  std::optional<Fit> smallest_holding() const;
  double expected(size_t point) const { return curve_.points[point].relative_l2; }
  /// The smallest point with an expected error within `error`, at most largest_.
  size_t smallest_within(double error) const;
  size_t beyond(const Fit& failing) const;
  size_t between(const Fit& failing, const Fit& holding) const;
  double height(size_t point) const;

  OrderCurve curve_;
  size_t largest_;
  double tolerance_;
  std::vector<Fit> fits_;
};

// A BTF fit at the requested size.

struct SizedFit {
  ModelBody body;
  BtfErrors errors;
  OrderCurve order;                  // scaled to the measured errors; the chosen point is the body's
  std::vector<SizeTrial> trials;     // the last one need not be the body
  std::optional<Warning> shortfall;  // if the tolerance is not met
  double seconds = 0;                // time of all fits, without measuring errors
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
