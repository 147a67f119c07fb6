// Draws from mixtures in flight: components chosen one by one, directions made together.
#pragma once

#include <span>

#include "sphere/direction_batch.h"
#include "srbf/kernel.h"

namespace velour {

struct LobeMixture;

/// Directions about axes of their own: what is left of the random numbers once the components are chosen. For draws
/// from several mixtures of one kernel; sample_mixture does the same for one.
struct alignas(64) LobeDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  static constexpr float kCosine = -1;             // for a bandwidth
  float x[kCapacity], y[kCapacity], z[kCapacity];  // axis, unit
  float bandwidth[kCapacity];                      // negative: no lobe but the cosine about the axis
  float u[kCapacity], rest[kCapacity];             // the zenith's number and 1 - u, both with all their digits
  float azimuth[kCapacity];                        // in [0, 1)
  int count = 0;

  /// Chooses a component of `mixture` for each of `numbers`; no more than kCapacity in all. Lobes are drawn from the
  /// rim to the centre and from the centre to the rim by turns, so that where lobes lie over each other a step from one
  /// slice of the numbers to the next is a small step on the sphere.
  void choose(const LobeMixture& mixture, std::span<const Vec2> numbers);
  void push(const Vec3& axis, float lobe_bandwidth, double u_zenith, float u_azimuth);
  /// The directions, in the order of choose(). The batch is not padded. Run-time dispatched SIMD.
  void directions(Kernel kernel, DirectionBatch& w);
};

}  // namespace velour
