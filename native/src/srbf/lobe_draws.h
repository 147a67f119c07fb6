// Batched sampling of mixtures: chooses components one by one, then computes the directions together.
#pragma once

#include <span>

#include "sphere/direction_batch.h"
#include "srbf/kernel.h"

namespace velour {

struct LobeMixture;

/// Pending samples, each about its own axis, with the random numbers remapped by the choice of components. Can sample
/// several mixtures of one kernel; sample_mixture samples a single one.
struct alignas(64) LobeDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  static constexpr float kCosine = -1;             // bandwidth of the cosine
  float x[kCapacity], y[kCapacity], z[kCapacity];  // axis, unit
  float bandwidth[kCapacity];                      // negative: the cosine about the axis, not a lobe
  float u[kCapacity], rest[kCapacity];             // random number of the zenith and 1 - u, both precise
  float azimuth[kCapacity];                        // in [0, 1)
  int count = 0;

  /// Chooses a component of `mixture` for each of `numbers`; at most kCapacity in total. Odd lobes reverse the zenith
  /// number, so that where lobes overlap, numbers just below and above the limit between two lobes map to close
  /// directions.
  void choose(const LobeMixture& mixture, std::span<const Vec2> numbers);
  void push(const Vec3& axis, float lobe_bandwidth, double u_zenith, float u_azimuth);
  /// Computes the directions, in the order of choose(). The batch is not padded. Run-time dispatched SIMD.
  void directions(Kernel kernel, DirectionBatch& w);
};

}  // namespace velour
