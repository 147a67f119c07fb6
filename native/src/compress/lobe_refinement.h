// Refinement of shared lobes by descent.
#pragma once

#include "compress/surface_points.h"

namespace velour {

struct RefinementOptions {
  uint32_t tile_lobes = 0;  // number of lobes in the tile's frame
  int steps = 0;
  int threads = 0;
};

/// Minimizes the error of color axis 0 over all vectors of all lobes, where every point has its best coefficients
/// (variable projection [GP73]). Zero vectors start as short ones; from there the error never rises. The same bits for
/// any number of threads.
std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress);

}  // namespace velour
