// Functions of clustered tensors solved for anew, for coefficients that are given.
#pragma once

#include <vector>

#include "compress/tensor_functions.h"
#include "compress/view_moments.h"

namespace velour {

/// Ranks of all clusters that are solved for at once; factors with more stay as they are.
inline constexpr Index kMostJointRanks = 640;

struct RefitOptions {
  int rounds = 2;
  int threads = 0;
};

/// Least squares over the images that `moments` (of every view) were summed from: by turns the rows of the lights'
/// factors, those of the views', and the cores, each with the rest as it is, of all clusters together. No step raises
/// the error. Factors are orthonormal in the end. Returns the least squares' value after each step, without the images'
/// own squares.
std::vector<double> refit_functions(const std::vector<ViewMoments>& moments, const RefitOptions& options,
                                    const Progress& progress, std::vector<DirectionCluster>& clusters);

}  // namespace velour
