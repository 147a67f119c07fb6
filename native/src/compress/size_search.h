// Which size of a model has an error that is asked for.
#pragma once

#include <optional>

#include "model/btf_record.h"
#include "model/order_curve.h"

namespace velour {

/// Looks for the smallest model within a tolerance by few fits. A curve that was known before any fit gives the shape
/// of errors against size; each fit that was measured gives its height there. Where fits lie on both sides of the
/// tolerance the height between them is interpolated, in logarithms.
class SizeSearch {
 public:
  /// `curve`: errors expected; no point beyond `largest` is asked for. `tolerance` 0: the largest alone.
  SizeSearch(const OrderCurve& curve, size_t largest, double tolerance);

  /// The point to fit next; nothing when the search is over.
  std::optional<size_t> next() const;
  void add(size_t point, double error);

  /// The point that the search ends with, of those fitted: the smallest within the tolerance, else the closest.
  size_t best() const;
  bool met() const;
  /// In the order of the fits.
  std::vector<SizeTrial> trials() const;

  /// The curve at the heights that were measured, with best() as the chosen point: at most `most` of its points, evenly
  /// spread by logarithm, and all that were fitted.
  OrderCurve measured_curve(size_t most) const;
  /// One sentence: by how much the tolerance is missed, and what would do.
  std::string shortfall() const;

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
  /// The smallest point that the curve expects to be within `error`, at most largest_.
  size_t smallest_within(double error) const;
  size_t beyond(const Fit& failing) const;
  size_t between(const Fit& failing, const Fit& holding) const;
  double height(size_t point) const;

  OrderCurve curve_;
  size_t largest_;
  double tolerance_;
  std::vector<Fit> fits_;
};

}  // namespace velour
