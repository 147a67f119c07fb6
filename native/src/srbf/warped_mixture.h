// The lobes of a parametric model at one view: value and density of many directions, and samples.
//
// Each lobe has a parameterisation of its own (warped_lobe.h) and, where there is a density, a second Gaussian for it
// in the same parameterisation.
#pragma once

#include <cstdint>
#include <span>

#include "sphere/direction_batch.h"

namespace velour {

/// Structure of arrays of `padded` elements; those past `count` hold lobes of value and density 0. Filled by whoever
/// owns the lobes; scratch memory of a thread.
struct alignas(64) WarpedMixture {
  static constexpr int kCapacity = 32;
  /// Lanes over lobes take 8 at once, or 16 where there are more.
  static constexpr int padded_of(int count) { return count <= 8 ? 8 : (count + 15) / 16 * 16; }

  // The arrays come first: vectors are loaded from them.
  // psi = normalize(S (wl + half wv)), S = [[s_xx, s_xy], [s_xy, s_yy]] (+) 1 of determinant 1; half is 0 or 1.
  float half[kCapacity];
  float s_xx[kCapacity], s_xy[kCapacity], s_yy[kCapacity];

  // f = sum of (r, g, b) exp(-bandwidth |psi - (x, y, z)|^2 / 2).
  float x[kCapacity], y[kCapacity], z[kCapacity];
  float bandwidth[kCapacity];
  float r[kCapacity], g[kCapacity], b[kCapacity];

  // The density over psi: sum of density exp(-draw_bandwidth |psi - (draw_x, draw_y, draw_z)|^2 / 2), where density is
  // the probability of the lobe / the integral of its kernel.
  float draw_x[kCapacity], draw_y[kCapacity], draw_z[kCapacity];
  float draw_bandwidth[kCapacity];
  float draw_tail[kCapacity];  // exp(-2 draw_bandwidth), the kernel against the centre
  float density[kCapacity];
  /// Running sums of the probabilities: from kSums on those of the lobes, 1 but for rounding at the last and past it;
  /// right before them that of the cosine about the normal, which comes first, and before it 0.
  static constexpr int kSums = 16;
  float sums[kSums + kCapacity];
  float cosine() const { return sums[kSums - 1]; }

  int count, padded;
  /// The lobes that have value or density at this view: loops over lobes leave the others out.
  const uint8_t* listed;
  int listed_count;
  /// The lobes' frame is the surface's, turned about the normal by an angle of this cosine and sine.
  float turn_cos, turn_sin;
  Vec3 wv;  // in the lobes' frame

  void list_all();  // once count is set
};

/// f[i]   = the value at wl_i, without cosine; 0 at and below the horizon.
/// pdf[i] = density of sample_warped at wl_i, per solid angle. Over the sphere its integral is 1 less the share of
///          draws that have no direction.
/// Of up to 64 directions in the surface's frame, padded. Run-time dispatched SIMD: lanes hold lobes for one or two
/// directions, else directions. Relative error of a kernel: 1e-6 plus 1e-6 times its exponent, for float parameters and
/// directions; in half space the exponent's error grows by 1 / |wl + wv| of what the directions have.
void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf);
/// The same of one direction.
void eval_warped(const WarpedMixture& mixture, const Vec3& wl, Rgb& f, float& pdf);
/// The value alone, of mixtures without a density.
void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f);
Rgb eval_warped(const WarpedMixture& mixture, const Vec3& wl);

/// Draws a direction for each of up to 64 `u`: `u.x` picks lobe and zenith about its centre, `u.y` the azimuth. Half
/// vectors that face away from the viewer have no light direction: the draw is then -z, which counts as a draw that
/// brought nothing. The batch is not padded. Run-time dispatched SIMD.
void sample_warped(const WarpedMixture& mixture, std::span<const Vec2> u, DirectionBatch& wl);
/// The same of one.
Vec3 sample_warped(const WarpedMixture& mixture, const Vec2& u);

}  // namespace velour
