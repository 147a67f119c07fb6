// Descent of shared lobes.
#pragma once

#include "compress/surface_points.h"

namespace velour {

struct RefinementOptions {
  uint32_t tile_lobes = 0;  // how many of the lobes are in the tile's frame
  int steps = 0;
  int threads = 0;
};

/// All vectors of all lobes descend the error of colour axis 0 that is left when every point has its best coefficients
/// (variable projection [GP73]). A vector of no length starts as a short one, and from there the error never rises; the
/// same bits for any number of threads.
std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress);

}  // namespace velour
