// Solves for the texels of a side level by level.
#pragma once

#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/side_views.h"
#include "btf/fit/srbf/srbf_fit.h"
#include "btf/model/srbf_btf.h"

namespace velour {

struct TexelLevelsInput {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // per level, finest first
  const SharedLobes& lobes;
  Companding companding;
  int threads;
};

/// Sets the levels of `side`, which has the input's lobes, from one texel to the finest level, each from the coarser
/// one. Reads every view once, unless the checkpoint has all levels under `stage`. Progress covers the stage.
void solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                  const std::string& stage, Progress& progress, SrbfSide& side);

}  // namespace velour
