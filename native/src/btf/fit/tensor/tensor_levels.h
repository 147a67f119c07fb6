// Solves for the texels of a side of clustered tensors on all levels.
#pragma once

#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/fit/tensor/tensor_texels.h"
#include "btf/model/tensor_btf.h"

namespace velour {

/// Sets the levels and scales of `side`, whose clusters are set, and refits its clusters: each level is solved for on
/// its own, scaled to the brightness of its images and rounded. Reads every view up to four times; steps in the
/// checkpoint under `stage` are reused. Progress covers the stage.
void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side);

// Rounding of the coefficients of clustered tensors to bytes.

/// Sets the scales of the clusters and the members and bytes of the levels of `side`, whose clusters and level sizes
/// are set. A scale spans the values of all levels; the effect of rounding a coefficient on a texel is compensated by
/// the coefficients after it (rounding_moves).
void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, TensorSide& side);

}  // namespace velour
