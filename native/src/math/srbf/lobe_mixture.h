// A flat mixture of SRBF lobes for one shading point: value and density of many directions in one pass, and sampling.
//
// It is filled once per camera ray (with the lobes of neighboring views, rotated into the local frame and weighted) and
// evaluated for a batch of directions. Value and density share every kernel evaluation.
#pragma once

#include <span>
#include "math/sphere/directions.h"
#include "math/srbf/kernel.h"

namespace velour {

/// Lobes shared by many mixtures, with precomputed values. Structure of arrays of `count` elements.
struct LobeSpan {
  const float *x, *y, *z;  // centers, unit
  const float* bandwidth;
  const float *r, *g, *b;  // coefficients of f cos
  const float* luminance;  // of the coefficient, never negative
  const float* mass;       // luminance x integral of the kernel
  int count;
};

struct alignas(64) LobeMixture {
  static constexpr int kCapacity = 448;
  static constexpr float kMinMass = 1e-30f;  // of all lobes; less counts as 0, as its reciprocal may overflow

  Kernel kernel = Kernel::gaussian;
  int count = 0;
  /// Probability of the cosine component, i.e. of the diffuse term and the defensive share; 1 if lobes have no mass.
  float cosine_share = 1;
  float diffuse_r = 0, diffuse_g = 0, diffuse_b = 0;  // coefficients of max(w.z, 0) in the value

  float x[kCapacity], y[kCapacity], z[kCapacity];  // centers, unit
  float bandwidth[kCapacity];
  float r[kCapacity], g[kCapacity], b[kCapacity];  // coefficients of the value, f cos
  float density[kCapacity];  // probability of the lobe among all components / integral of its kernel
  float cdf[kCapacity];      // running sum of probabilities among lobes only; the last is 1

  /// Empties the mixture: its value is 0 and its density the cosine.
  void clear(Kernel k) {
    kernel = k;
    count = 0;
    cosine_share = 1;
    diffuse_r = diffuse_g = diffuse_b = 0;
  }
  /// Adds a lobe of unit `center`. Callers bound their lobes by kCapacity (asserted).
  void add(const Vec3& center, float lobe_bandwidth, const Rgb& coefficient);
  /// Adds `lobes` with centers rotated by `rotation` and coefficients times `weight` >= 0. Fast: no kernel integrals.
  void append(const LobeSpan& lobes, const Mat3& rotation, float weight);
  /// Adds a diffuse term to the value: `coefficient` >= 0 times the clipped cosine.
  void add_diffuse(const Rgb& coefficient) {
    diffuse_r += coefficient.r;
    diffuse_g += coefficient.g;
    diffuse_b += coefficient.b;
  }
  /// Computes `density`, `cdf` and `cosine_share`: the probability of a lobe, and of the diffuse term, is proportional
  /// to luminance(coefficient) x integral, times 1 - defensive_share; the cosine gets the remaining probability. Call
  /// once after the last lobe and before the functions below.
  void finish(float defensive_share);
};

/// value[i] = diffuse max(w_i.z, 0) + sum_j coefficient_j G_j(w_i)  (f cos, 1/sr; lobes are not clamped at the horizon)
/// pdf[i]   = density of sample_mixture at w_i, per solid angle over the whole sphere.
/// The batch is padded. Run-time dispatched SIMD; values past the count of the batch are meaningless. Relative error
/// of a kernel: 3e-7 plus 2e-7 times its exponent, for float directions; exactly 0 below e^-88.
void eval_mixture(const LobeMixture& mixture, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf);

/// Evaluates only the density.
void eval_density(const LobeMixture& mixture, const DirectionBatch& w, ScalarBatch& pdf);

/// Samples a direction for each of up to 64 `u`: `u.x` selects the component and the zenith about the lobe
/// (LobeDraws::choose), `u.y` the azimuth. Directions may lie below the horizon. The batch is not padded. Run-time
/// dispatched SIMD: a direction is within 6e-7, relative to the sine of the zenith, of that of kernel_sample in double,
/// except at the antipode, where 1 - cos is rounded.
void sample_mixture(const LobeMixture& mixture, std::span<const Vec2> u, DirectionBatch& w);
Vec3 sample_mixture(const LobeMixture& mixture, const Vec2& u);

// Batched sampling of mixtures: chooses components one by one, then computes the directions together.

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
