// Batched sampling of a warped mixture: chooses components one by one, then computes the directions together.
#pragma once

#include "srbf/warped_mixture.h"

namespace velour {

/// Pending samples: the random numbers remapped by the choice of components, and parameters of the chosen lobes.
struct alignas(64) WarpedDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  float x[kCapacity], y[kCapacity], z[kCapacity];  // axis
  float bandwidth[kCapacity];                      // negative: the cosine about the axis
  float tail[kCapacity];
  float half[kCapacity], s_xx[kCapacity], s_xy[kCapacity], s_yy[kCapacity];
  float u[kCapacity], rest[kCapacity];  // random number of the zenith and 1 - u, both precise
  float azimuth[kCapacity];             // in [0, 1)
  int count = 0;

  /// Adds a sample of `lobe`, or of the cosine if it is -1, i.e. of a light direction about the normal without stretch.
  /// Branchless, because the choice cannot be predicted.
  void push(const WarpedMixture& m, int lobe, float u_zenith, float rest_zenith, float u_azimuth) {
    const int j = lobe < 0 ? 0 : lobe;
    const auto is_lobe = static_cast<float>(lobe >= 0), is_cosine = 1 - is_lobe;
    x[count] = is_lobe * m.draw_x[j];
    y[count] = is_lobe * m.draw_y[j];
    z[count] = is_lobe * m.draw_z[j] + is_cosine;
    bandwidth[count] = is_lobe * m.draw_bandwidth[j] - is_cosine;
    tail[count] = m.draw_tail[j];
    half[count] = is_lobe * m.half[j];
    s_xx[count] = is_lobe * m.s_xx[j] + is_cosine;
    s_xy[count] = is_lobe * m.s_xy[j];
    s_yy[count] = is_lobe * m.s_yy[j] + is_cosine;
    u[count] = u_zenith;
    rest[count] = rest_zenith;
    azimuth[count++] = u_azimuth;
  }
};

}  // namespace velour
