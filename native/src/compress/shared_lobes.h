// The lobes that all texels of a BTF share.
#pragma once

#include "compress/surface_points.h"

namespace velour {

/// Lobes in the tile's frame, then lobes in that of the relief's normal, and which of them each colour axis uses.
struct SharedLobes {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // of axis 0: all, in order
};

struct SharedLobeOptions {
  size_t coefficients = 0;  // of a texel, over the three axes
  int refinements = 0;      // steps of descent
  uint64_t seed = 0;
  int threads = 0;
};

/// Chosen greedily among random ones - of light, view, half vector and their products, in both frames -, then refined
/// together: all their vectors descend the error that is left when every point has its best coefficients (variable
/// projection [GP73]). The colour axes share the coefficients by what each next one explains.
SharedLobes choose_lobes(const std::vector<SurfacePoint>& points, const SharedLobeOptions& options, Progress& progress);

}  // namespace velour
