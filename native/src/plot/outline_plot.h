// What an outline leaves open, against the view.
#pragma once

#include "job/progress.h"
#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// Share of a tile that its structure covers, at view angles three degrees apart: the mean over azimuths, and the least
/// and the most of them. Throws Error(unsupported) for a model without outline (VOTF).
Plot outline_plot(const Model& model, Progress& progress);

}  // namespace velour
