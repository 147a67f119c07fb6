// Refit of the cores of clustered tensors for given factors and coefficients.
#pragma once

#include <vector>

#include "compress/tensor_functions.h"
#include "compress/view_moments.h"

namespace velour {

/// Solves for the cores of all clusters together: least squares over the images that `moments` (of every view) were
/// summed from, by conjugate gradients ([HS52]) from their current values; fastest if factors are orthonormal. The same
/// bits for any number of threads.
void refit_cores(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
                 std::vector<DirectionCluster>& clusters);

}  // namespace velour
