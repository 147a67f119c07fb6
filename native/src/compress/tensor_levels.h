// The texels of a side of clustered tensors, on all levels.
#pragma once

#include "btf/tensor_btf.h"
#include "compress/direction_bases.h"
#include "compress/fit_checkpoint.h"

namespace velour {

/// Sets the levels and scales of `side`, whose clusters are set: each level is solved for on its own, made as bright as
/// its images and rounded. Reads every view once, unless the checkpoint has kept all levels under `stage`. Progress
/// covers the stage.
void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side);

}  // namespace velour
