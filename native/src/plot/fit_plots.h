// Plots of the errors recorded by a fit.
#pragma once

#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// BRDF: the worst view's error over the tolerance against lobes. BTF: the error against bytes. Throws
/// Error(unsupported) if nothing was recorded.
Plot order_plot(const Model& model);

/// Relative L2 at the reported views. Throws Error(unsupported) if there is none.
Plot view_error_plot(const FitRecord& fit);

}  // namespace velour
