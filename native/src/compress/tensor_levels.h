// Solves for the texels of a side of clustered tensors on all levels.
#pragma once

#include "btf/tensor_btf.h"
#include "compress/direction_bases.h"
#include "compress/fit_checkpoint.h"

namespace velour {

/// Sets the levels and scales of `side`, whose clusters are set, and refits its clusters: each level is solved for on
/// its own, scaled to the brightness of its images and rounded. Reads every view up to four times; steps in the
/// checkpoint under `stage` are reused. Progress covers the stage.
void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side);

}  // namespace velour
