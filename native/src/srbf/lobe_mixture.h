// A flat mixture of SRBF lobes for one shading point: value and density of many directions in one pass, and sampling.
//
// It is filled once a camera ray (the neighbouring views' lobes, already rotated into the local frame and weighted) and
// asked for a batch of directions. Value and density share every kernel evaluation.
#pragma once

#include <span>

#include "sphere/direction_batch.h"
#include "srbf/kernel.h"

namespace velour {

/// Lobes kept for many mixtures, structure of arrays of `count` elements, with what depends on the lobe alone.
struct LobeSpan {
  const float *x, *y, *z;  // centres, unit
  const float* bandwidth;
  const float *r, *g, *b;  // coefficients of f cos
  const float* luminance;  // of the coefficient, never negative
  const float* mass;       // luminance x integral of the kernel
  int count;
};

struct alignas(64) LobeMixture {
  static constexpr int kCapacity = 448;
  static constexpr float kLeastMass = 1e-30f;  // of all lobes; less is none, because one over it is near no float

  Kernel kernel = Kernel::gaussian;
  int count = 0;
  /// Probability of the cosine component: that of the diffuse term and the defence; 1 when the lobes have no mass.
  float cosine_share = 1;
  float diffuse_r = 0, diffuse_g = 0, diffuse_b = 0;  // coefficients of max(w.z, 0) in the value

  float x[kCapacity], y[kCapacity], z[kCapacity];  // centres, unit
  float bandwidth[kCapacity];
  float r[kCapacity], g[kCapacity], b[kCapacity];  // coefficients of the value, f cos
  float density[kCapacity];  // probability of the lobe, cosine component counted in, / integral of its kernel
  float cdf[kCapacity];      // running sum of the lobes' probabilities among the lobes, last = 1

  /// Empty: the value 0, and a plain cosine density.
  void clear(Kernel k) {
    kernel = k;
    count = 0;
    cosine_share = 1;
    diffuse_r = diffuse_g = diffuse_b = 0;
  }
  /// Adds a lobe of unit `center`. Callers bound their lobes by kCapacity (asserted).
  void add(const Vec3& center, float lobe_bandwidth, const Rgb& coefficient);
  /// Adds `lobes`, centres turned by `rotation`, coefficients times `weight` >= 0. The fast way: no kernel integral.
  void append(const LobeSpan& lobes, const Mat3& rotation, float weight);
  /// Adds `coefficient` >= 0 times the clipped cosine to the value: the diffuse part.
  void add_diffuse(const Rgb& coefficient) {
    diffuse_r += coefficient.r;
    diffuse_g += coefficient.g;
    diffuse_b += coefficient.b;
  }
  /// Turns what was added into `density`, `cdf` and `cosine_share`: the probability of a lobe, and of the diffuse term,
  /// is proportional to luminance(coefficient) x integral, times 1 - defensive_share; the rest is cosine too. Call once
  /// after the last lobe and before the functions below.
  void finish(float defensive_share);
};

/// value[i] = diffuse max(w_i.z, 0) + sum_j coefficient_j G_j(w_i)  (f cos, 1/sr; lobes are not clamped at the horizon)
/// pdf[i]   = density of sample_mixture at w_i, per solid angle over the whole sphere.
/// The batch is padded. Run-time dispatched SIMD; lanes past the batch's count are computed and meaningless. Relative
/// error of a kernel: 3e-7 plus 2e-7 times its exponent, for float directions; exactly 0 below e^-88.
void eval_mixture(const LobeMixture& mixture, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf);

/// The density alone.
void eval_density(const LobeMixture& mixture, const DirectionBatch& w, ScalarBatch& pdf);

/// Draws a direction for each of up to 64 `u`: `u.x` picks component and zenith about the lobe (LobeDraws::choose),
/// `u.y` the azimuth. May lie below the horizon. The batch is not padded. Run-time dispatched SIMD: a direction is
/// within 6e-7 of the one that kernel_sample gives in double, relative to the zenith's sine, but for the antipode,
/// where 1 - cos is rounded.
void sample_mixture(const LobeMixture& mixture, std::span<const Vec2> u, DirectionBatch& w);
Vec3 sample_mixture(const LobeMixture& mixture, const Vec2& u);

}  // namespace velour
