// What turns the directions psi of warped lobes into light directions.
#pragma once

#include "sphere/direction_batch.h"

namespace velour {

/// The parameterisation of each draw of a batch, as in WarpedMixture. Draws of the cosine are light directions already:
/// light space without stretch.
struct alignas(64) Unwarps {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  float half[kCapacity], s_xx[kCapacity], s_xy[kCapacity], s_yy[kCapacity];

  void set(int i, float is_half, float xx, float xy, float yy) {
    half[i] = is_half;
    s_xx[i] = xx;
    s_xy[i] = xy;
    s_yy[i] = yy;
  }
};

}  // namespace velour
