// How the error of a fit falls as its model grows, and where the fit stopped.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace velour {

/// The best fit found with at most this many lobes.
struct OrderPoint {
  int lobes = 0;  // scattered: of the view that has most; parametric: in all
  uint64_t parameter_bytes = 0;
  double worst = 0;  // of a fitted view: largest relative L2 over the tolerance, less what the fold took of that; at
                     // most 1 where the fit holds
  double relative_l2 = 0;  // mean over the fitted views, weighted as the fit does

  bool operator==(const OrderPoint&) const = default;
};

struct OrderCurve {
  std::vector<OrderPoint> points;  // in the order of parameter_bytes; empty: not recorded
  std::optional<size_t> chosen;    // the point that the model is

  bool operator==(const OrderCurve&) const = default;
};

}  // namespace velour
