// Refit of the functions of clustered tensors for given coefficients.
#pragma once

#include <vector>
#include "btf/fit/tensor/tensor_functions.h"

namespace velour {

/// Maximum total rank of all clusters that is solved for jointly; factors with more stay unchanged.
inline constexpr Index kMaxJointRanks = 640;

struct RefitOptions {
  int rounds = 2;
  int threads = 0;
};

/// Alternating least squares over the images that `moments` (of every view) were summed from: the light factors, the
/// view factors and the cores in turn, for all clusters jointly. No step raises the error. The resulting factors are
/// orthonormal. Returns the objective at the start and after each step, without the squares of the images themselves.
std::vector<double> refit_functions(const std::vector<ViewMoments>& moments, const RefitOptions& options,
                                    const Progress& progress, std::vector<DirectionCluster>& clusters);

// Refit of the cores of clustered tensors for given factors and coefficients.

/// Solves for the cores of all clusters together: least squares over the images that `moments` (of every view) were
/// summed from, by conjugate gradients ([HS52]) from their current values; fastest if factors are orthonormal. The same
/// bits for any number of threads.
void refit_cores(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
                 std::vector<DirectionCluster>& clusters);

}  // namespace velour
