// How directions drawn from two densities are put together to one estimate.
#pragma once

#include "render/options.h"

namespace velour {

/// Multi-sample combination [VG95]: of n directions the share c_l is drawn from the lights with density p_l, the rest
/// c_s = 1 - c_l from the surface with p_s. With q = c p a direction counts f / (n d):
///   balance  d = q_l + q_s                    w = q / (q_l + q_s)
///   power    d = (q_l^2 + q_s^2) / q_own      w = q^2 / (q_l^2 + q_s^2), exponent 2
/// where "own" is the side that drew it. A share of 0 or 1 leaves one density alone.
struct Combination {
  float light_share;
  Heuristic heuristic;

  /// d of a direction that the surface (or the lights) drew.
  float surface_drew(float surface_pdf, float light_pdf) const {
    return effective((1.0f - light_share) * surface_pdf, light_share * light_pdf);
  }
  float light_drew(float surface_pdf, float light_pdf) const {
    return effective(light_share * light_pdf, (1.0f - light_share) * surface_pdf);
  }

 private:
  float effective(float own, float other) const {
    // A quotient, not squares: densities of sharp lobes and suns squared leave float32.
    if (heuristic == Heuristic::power && other > 0.0f) return own + other * (other / own);
    return own + other;
  }
};

/// The combination of a strategy: mixed ones have both sides, the others one.
inline Combination combination(const RenderOptions& options) {
  return {is_mixed(options.strategy) ? options.light_share : (options.strategy == Strategy::light ? 1.0f : 0.0f), options.heuristic};
}

}  // namespace velour
