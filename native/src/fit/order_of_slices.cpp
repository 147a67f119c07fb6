#include "fit/order_of_slices.h"

#include <algorithm>
#include <cmath>

#include "fit/fit_report.h"

namespace velour {
namespace {

size_t most_lobes(const FittedSlices& fitted) {
  size_t most = 0;
  for (const ViewPath& p : fitted.paths) most = std::max(most, p.path.size() - 1);
  return most;
}

/// The point of `fitted` with at most `lobes` lobes per view.
OrderPoint point_at(const FittedSlices& fitted, size_t lobes, double tolerance) {
  OrderPoint point{static_cast<int>(lobes), 0, 0, 0};
  double sum = 0, weights = 0;
  for (size_t i = 0; i < fitted.paths.size(); ++i) {
    const ViewPath& view = fitted.paths[i];
    const size_t kept = std::min(lobes, view.path.size() - 1);
    const double error = view.path[kept].relative_l2;
    const double theta_v = std::acos(std::min(fitted.slices[i].wv.z, 1.0f));
    point.parameter_bytes += ScatteredBrdf::kViewBytes + kept * ScatteredBrdf::kLobeBytes;
    point.worst = std::max(point.worst, error / tolerance_at(tolerance, theta_v));
    sum += view.importance * error;
    weights += view.importance;
  }
  if (weights > 0) point.relative_l2 = sum / weights;
  return point;
}

}  // namespace

OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance) {
  OrderCurve order;
  const size_t most = most_lobes(all);
  for (size_t lobes = 1; lobes < most; lobes *= 2) order.points.push_back(point_at(all, lobes, tolerance));
  order.points.push_back(point_at(all, most, tolerance));
  const OrderPoint model = point_at(chosen, most_lobes(chosen), tolerance);
  const auto smaller = [](const OrderPoint& a, const OrderPoint& b) { return a.parameter_bytes < b.parameter_bytes; };
  auto at = std::lower_bound(order.points.begin(), order.points.end(), model, smaller);
  if (at == order.points.end() || *at != model) at = order.points.insert(at, model);
  order.chosen = static_cast<size_t>(at - order.points.begin());
  return order;
}

}  // namespace velour
