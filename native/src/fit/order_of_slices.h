// The order curve of a scattered fit, read off the greedy paths of its views: no view is fitted again.
#pragma once

#include "fit/fitted_slices.h"
#include "model/order_curve.h"

namespace velour {

/// The points of at most 1, 2, 4, ... lobes a view out of `all`, and `chosen`, what became the model. Errors are those
/// of the views at their own samples: the interpolation between views is not in them.
OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance);

}  // namespace velour
