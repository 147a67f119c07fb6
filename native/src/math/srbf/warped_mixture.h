// The lobes of a parametric model at one view: value and density of many directions, and samples.
//
// Each lobe has its own parameterization (warped_lobe.h) and, if the mixture has a density, a second Gaussian for it in
// the same parameterization.
#pragma once

#include <cstdint>
#include <span>
#include "math/sphere/directions.h"

namespace velour {

/// Structure of arrays of `padded` elements; those past `count` hold lobes of value and density 0. Filled by the owner
/// of the lobes; per-thread scratch memory.
struct alignas(64) WarpedMixture {
  static constexpr int kCapacity = 32;
  /// SIMD loops over lobes take 8 at once, or 16 if there are more than 8.
  static constexpr int padded_of(int count) { return count <= 8 ? 8 : (count + 15) / 16 * 16; }

  // The arrays come first so that vector loads from them are aligned.
  // psi = normalize(S (wl + half wv)), S = [[s_xx, s_xy], [s_xy, s_yy]] (+) 1 of determinant 1; half is 0 or 1.
  float half[kCapacity];
  float s_xx[kCapacity], s_xy[kCapacity], s_yy[kCapacity];

  // f = sum of (r, g, b) exp(-bandwidth |psi - (x, y, z)|^2 / 2).
  float x[kCapacity], y[kCapacity], z[kCapacity];
  float bandwidth[kCapacity];
  float r[kCapacity], g[kCapacity], b[kCapacity];

  // Density over psi: sum of density exp(-draw_bandwidth |psi - (draw_x, draw_y, draw_z)|^2 / 2), where density is
  // the probability of the lobe / the integral of its kernel.
  float draw_x[kCapacity], draw_y[kCapacity], draw_z[kCapacity];
  float draw_bandwidth[kCapacity];
  float draw_tail[kCapacity];  // exp(-2 draw_bandwidth), the kernel at the antipode
  float density[kCapacity];
  /// Running sums of the probabilities: 0, then the cosine about the normal at kSums - 1, then the lobes from kSums on;
  /// 1, up to rounding, from the last lobe on.
  static constexpr int kSums = 16;
  float sums[kSums + kCapacity];
  float cosine() const { return sums[kSums - 1]; }

  int count, padded;
  /// Lobes that have value or density at this view; loops over lobes skip the others.
  const uint8_t* listed;
  int listed_count;
  /// The frame of the lobes is that of the surface, rotated about the normal by an angle of this cosine and sine.
  float turn_cos, turn_sin;
  Vec3 wv;  // in the lobes' frame

  void list_all();  // requires count
};

/// f[i]   = the value at wl_i, without cosine; 0 at and below the horizon.
/// pdf[i] = density of sample_warped at wl_i, per solid angle. Its integral over the sphere is 1 minus the share of
///          samples that have no direction.
/// Takes up to 64 directions in the frame of the surface, padded. Run-time dispatched SIMD: lanes hold lobes for one or
/// two directions, directions otherwise. Relative error of a kernel: 1e-6 plus 1e-6 times its exponent, for float
/// parameters and directions; in half space the exponent also has the error of the directions times 1 / |wl + wv|.
void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf);
/// Evaluates one direction.
void eval_warped(const WarpedMixture& mixture, const Vec3& wl, Rgb& f, float& pdf);
/// Evaluates only the value, for mixtures without a density.
void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f);
Rgb eval_warped(const WarpedMixture& mixture, const Vec3& wl);

/// Samples a direction for each of up to 64 `u`: `u.x` selects the lobe and the zenith about its center, `u.y` the
/// azimuth. Half vectors that face away from the viewer have no light direction: the sample is then -z, which counts as
/// a sample of value 0. The batch is not padded. Run-time dispatched SIMD.
void sample_warped(const WarpedMixture& mixture, std::span<const Vec2> u, DirectionBatch& wl);
/// Samples one direction.
Vec3 sample_warped(const WarpedMixture& mixture, const Vec2& u);

// Batched sampling of a warped mixture: chooses components one by one, then computes the directions together.

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

// Sampling density of a warped mixture from its own lobes.

/// Sets the density of `mixture`, whose value is already set: its lobes in proportion to luminance times integral over
/// psi, ignoring horizon and cosine, plus the cosine about the normal with a share of `cosine`.
void draw_plain_lobes(WarpedMixture& mixture, float cosine);

}  // namespace velour
