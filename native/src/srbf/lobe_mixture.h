// A flat mixture of SRBF lobes for one shading point: value and density of many directions in one pass, and sampling.
//
// It is filled once a camera ray (the neighbouring views' lobes, already rotated into the local frame and weighted) and
// asked for a batch of directions. Value and density share every kernel evaluation.
#pragma once

#include "sphere/direction_batch.h"
#include "srbf/kernel.h"

namespace velour {

struct alignas(64) LobeMixture {
  static constexpr int kCapacity = 256;

  Kernel kernel = Kernel::gaussian;
  int count = 0;
  float cosine_share = 0;  // probability of the defensive cosine component; 1 when there are no lobes

  float x[kCapacity], y[kCapacity], z[kCapacity];  // centres, unit
  float bandwidth[kCapacity];
  float r[kCapacity], g[kCapacity], b[kCapacity];  // coefficients of the value, f cos
  float density[kCapacity];                        // probability of the lobe / integral of its kernel
  float cdf[kCapacity];                            // running sum of the probabilities of the lobes, last = 1

  void clear(Kernel k) {
    kernel = k;
    count = 0;
  }
  /// Adds a lobe; silently full at kCapacity is impossible: callers bound neighbours x lobes (asserted).
  void add(const Vec3& center, float lobe_bandwidth, const Rgb& coefficient);
  /// Sets `density`, `cdf` from luminance(coefficient) x integral, with `defensive_share` for the cosine component.
  void finish(float defensive_share);
};

/// value[i] = sum_j coefficient_j G_j(w_i)  (f cos, 1/sr; not clamped at the horizon)
/// pdf[i]   = density of sample_mixture at w_i, per solid angle over the whole sphere.
/// Run-time dispatched SIMD; lanes past the batch's count are computed and meaningless.
void eval_mixture(const LobeMixture& mixture, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf);

/// Draws a direction; `u.x` picks component and zenith about the lobe, `u.y` the azimuth. May lie below the horizon.
Vec3 sample_mixture(const LobeMixture& mixture, const Vec2& u);

/// The instruction set that eval_mixture uses now, e.g. "AVX2"; and the choices this processor has, best first.
const char* simd_target();
/// Restricts dispatch to `name` ("auto" lifts it). Returns false when this processor or build does not have it.
bool select_simd_target(const char* name);

}  // namespace velour
