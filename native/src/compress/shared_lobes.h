// The lobes shared by all texels of a BTF.
#pragma once

#include "compress/lobe_order.h"

namespace velour {

/// Lobes in the tile's frame, then lobes in the frame of the relief's normal, and the lobes that each color axis uses.
struct SharedLobes {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // axis 0: all, in order
};

/// The unrefined lobes of the first `coefficients` coefficients of an order, whose candidates were made from `seed`.
SharedLobes chosen_lobes(const LobeOrder& order, size_t coefficients, uint64_t seed);

struct LobeRefinement {
  int steps = 0;  // steps of the descent
  int threads = 0;
};

/// Refines the lobes together by descent of the error that remains when every point has its best coefficients (variable
/// projection [GP73]). The weaker color axes then choose again, as many as in `share`, among the refined lobes.
void refine_lobes(const std::vector<SurfacePoint>& points, const std::array<size_t, 3>& share,
                  const LobeRefinement& options, SharedLobes& lobes, Progress& progress);

}  // namespace velour
