// Cores of clustered tensors solved for anew, for factors and coefficients that are given.
#pragma once

#include <vector>

#include "compress/tensor_functions.h"
#include "compress/view_moments.h"

namespace velour {

/// Least squares over the images that `moments` (of every view) were summed from, for the cores of all clusters
/// together, by conjugate gradients ([HS52]) from what they are; fastest where factors are orthonormal. The same bits
/// for any number of threads.
void refit_cores(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
                 std::vector<DirectionCluster>& clusters);

}  // namespace velour
