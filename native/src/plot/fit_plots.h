// What a fit found out of itself.
#pragma once

#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// Of a BRDF: the worst view's error over the tolerance against lobes. Of a BTF: the error against bytes. Throws
/// Error(unsupported) where nothing was recorded.
Plot order_plot(const Model& model);

/// Relative L2 at the reported views. Throws Error(unsupported) where there is none.
Plot view_error_plot(const FitRecord& fit);

}  // namespace velour
