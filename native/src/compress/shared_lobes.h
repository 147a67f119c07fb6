// The lobes that all texels of a BTF share.
#pragma once

#include "compress/lobe_order.h"

namespace velour {

/// Lobes in the tile's frame, then lobes in that of the relief's normal, and which of them each colour axis uses.
struct SharedLobes {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // of axis 0: all, in order
};

/// The lobes of the first `coefficients` of an order whose candidates were drawn from `seed`, as they were drawn.
SharedLobes chosen_lobes(const LobeOrder& order, size_t coefficients, uint64_t seed);

struct LobeRefinement {
  int steps = 0;  // of descent
  int threads = 0;
};

/// Refines them together: all their vectors descend the error that is left when every point has its best coefficients
/// (variable projection [GP73]). The weaker colour axes choose as many as `share` says anew among what came of them.
void refine_lobes(const std::vector<SurfacePoint>& points, const std::array<size_t, 3>& share,
                  const LobeRefinement& options, SharedLobes& lobes, Progress& progress);

}  // namespace velour
