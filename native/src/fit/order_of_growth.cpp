#include "fit/order_of_growth.h"

namespace velour {
namespace {

uint64_t bytes_of(ParametricBrdf brdf, int lobes) {
  brdf.space.assign(static_cast<size_t>(lobes), LobeSpace::light);
  brdf.control.resize(brdf.index(brdf.spline().node_count(), 0, 0));
  return brdf.parameter_bytes();
}

}  // namespace

OrderCurve order_of_growth(const TrackedFit& fit) {
  OrderCurve order;
  for (const OrderStep& step : fit.order) {
    order.points.push_back({step.lobes, bytes_of(fit.brdf, step.lobes), step.worst, step.mean});
  }
  if (!order.points.empty()) order.chosen = order.points.size() - 1;
  return order;
}

}  // namespace velour
