// Refit of the functions of clustered tensors for given coefficients.
#pragma once

#include <vector>

#include "compress/tensor_functions.h"
#include "compress/view_moments.h"

namespace velour {

/// Maximum total rank of all clusters that is solved for jointly; factors with more stay unchanged.
inline constexpr Index kMostJointRanks = 640;

struct RefitOptions {
  int rounds = 2;
  int threads = 0;
};

/// Alternating least squares over the images that `moments` (of every view) were summed from: the light factors, the
/// view factors and the cores in turn, for all clusters jointly. No step raises the error. The resulting factors are
/// orthonormal. Returns the objective at the start and after each step, without the squares of the images themselves.
std::vector<double> refit_functions(const std::vector<ViewMoments>& moments, const RefitOptions& options,
                                    const Progress& progress, std::vector<DirectionCluster>& clusters);

}  // namespace velour
