// The order curve of a parametric fit: the steps of its growth, and the model that became of them.
#pragma once

#include "fit/tracked_fit.h"
#include "model/order_curve.h"

namespace velour {

OrderCurve order_of_growth(const TrackedFit& fit);

}  // namespace velour
