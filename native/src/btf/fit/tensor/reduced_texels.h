// Texels in bases of the views and lights: the tensor to be clustered.
#pragma once

#include "btf/fit/tensor/direction_bases.h"

namespace velour {

struct ReducedTexels {
  std::vector<uint32_t> texel;  // on the finest level
  DenseTensor slices;           // [texel][view basis][light basis][axis]
  double relief_share;          // ReliefGap::share()
};

/// Values of `texels` in all views, projected on the bases. Texels hidden from some views are solved for by least
/// squares over the others, with the bases' energies as a prior. Reads every view once.
ReducedTexels reduced_texels(CompandedViews& views, const TensorSource& source, const DirectionBases& bases,
                             std::vector<uint32_t> texels, Progress& progress);

}  // namespace velour
