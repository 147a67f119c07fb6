// The order curve of a per-view fit, from the greedy paths of its views, without refitting.
#pragma once

#include "fit/fitted_slices.h"
#include "model/order_curve.h"

namespace velour {

/// The points of `all` with at most 1, 2, 4, ... lobes per view, and that of `chosen`, the stored model. Errors are
/// those of the views at their own samples, without the interpolation between views.
OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance);

}  // namespace velour
