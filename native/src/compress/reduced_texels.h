// Texels described in bases of the views and lights: the tensor that clusters are sought in.
#pragma once

#include "compress/direction_bases.h"

namespace velour {

struct ReducedTexels {
  std::vector<uint32_t> texel;  // of the finest level
  DenseTensor slices;           // [texel][view basis][light basis][axis]
  double relief_share;          // ReliefGap::share()
};

/// What views show of `texels`, projected on the bases. Of a texel that some views do not show, least squares over
/// those that do, with the bases' energies as what is expected of it. Reads every view once.
ReducedTexels reduced_texels(CompandedViews& views, const TensorSource& source, const DirectionBases& bases,
                             std::vector<uint32_t> texels, Progress& progress);

}  // namespace velour
