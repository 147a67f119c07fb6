// How directions drawn from several densities are put together to one estimate.
#pragma once

#include "render/options.h"

namespace velour {

/// Who drew a direction.
enum class Drawer : uint8_t { product = 0, surface = 1, lights = 2 };

/// Multi-sample combination [VG95]: of n directions the share c_k comes from density p_k; the shares sum to 1. With
/// q_k = c_k p_k a direction counts f / (n d):
///   balance  d = sum_k q_k               weight q_own / sum_k q_k
///   power    d = sum_k q_k^2 / q_own     weight q_own^2 / sum_k q_k^2, exponent 2
/// where "own" is the density that drew it. A share of 0 leaves a density out. This is d of `q`, by Drawer.
inline float effective_density(Heuristic heuristic, const float (&q)[3], Drawer own) {
  if (heuristic == Heuristic::balance) return q[0] + q[1] + q[2];
  const float q_own = q[static_cast<int>(own)];
  float d = 0.0f;
  // Quotients, not squares: densities of sharp lobes and suns squared leave float32. (A NaN density stays one.)
  for (const float other : q) d += other == 0.0f ? 0.0f : other * (other / q_own);
  return d;
}

/// How lamps and surfaces that glow are weighed, whatever is chosen for the environment. What is drawn towards one has
/// hardly any noise of its own where nothing stands before it, and the few directions of the surface that find it were
/// most of the noise under the balance heuristic: up to 12 times its variance (docs/rendering.md).
inline constexpr Heuristic kLampHeuristic = Heuristic::power;

/// Of `product`, where the sky gives all light: lamps take from it. Six of eight directions; what is left defends
/// against light and shadow that no lobe tells of.
inline constexpr float kProductShare = 0.75f;

/// Shares of a strategy, by Drawer.
struct Shares {
  float product = 0, surface = 0, lights = 0;
};

/// The shares at a vertex where `product` of the directions come from products and `instead` from the lights in their
/// place (both 0 for all strategies but `product`): mixed strategies share the rest between surface and lights, the
/// others have one density.
inline Shares shares(const RenderOptions& options, float product, float instead = 0) {
  const float lights =
      is_mixed(options.strategy) ? options.light_share : (options.strategy == Strategy::light ? 1.0f : 0.0f);
  const float rest = 1.0f - product - instead;
  return {product, rest * (1.0f - lights), rest * lights + instead};
}

}  // namespace velour
