// The texels of a side, solved for level by level.
#pragma once

#include "btf/srbf_btf.h"
#include "compress/fit_checkpoint.h"
#include "compress/shared_lobes.h"
#include "compress/side_views.h"

namespace velour {

struct TexelLevelsInput {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // of each level, the finest first
  const SharedLobes& lobes;
  Companding companding;
  int threads;
};

/// The levels of `side`, whose lobes are the input's: from one texel to the finest level, each from the one before.
/// Reads every view once, unless the checkpoint has kept all levels under `stage`. Progress covers the stage.
void solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                  const std::string& stage, Progress& progress, SrbfSide& side);

}  // namespace velour
