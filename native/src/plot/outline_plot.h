// Coverage of a VOTF against the view angle.
#pragma once

#include "job/progress.h"
#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// Share of a tile that its structure covers, at view angles three degrees apart: mean, minimum and maximum over
/// azimuths. Throws Error(unsupported) for a model without a VOTF.
Plot outline_plot(const Model& model, Progress& progress);

}  // namespace velour
