// Error of a fit over the size of its model, and the chosen size.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace velour {

/// The best fit found with at most this many lobes.
struct OrderPoint {
  int lobes = 0;  // per-view model: of the view with the most; parametric: in total
  uint64_t parameter_bytes = 0;
  double worst = 0;  // largest relative L2 of a fitted view over its tolerance, which the folding error reduces; at
                     // most 1 if the fit meets it
  double relative_l2 = 0;  // mean over the fitted views, weighted as the fit does

  bool operator==(const OrderPoint&) const = default;
};

struct OrderCurve {
  std::vector<OrderPoint> points;  // in the order of parameter_bytes; empty: not recorded
  std::optional<size_t> chosen;    // the point of the stored model

  bool operator==(const OrderCurve&) const = default;
};

}  // namespace velour
