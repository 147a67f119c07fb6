// Samples of one slice for the solver: f cos(theta_l) of one view at weighted light directions.
#pragma once

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

// Aligned for the widest vector registers.
using AlignedFloats = std::vector<float, oneapi::tbb::cache_aligned_allocator<float>>;

/// A light direction, its solid angle (sr) and the f cos measured there (1/sr).
struct SliceSample {
  Vec3 wl;
  float weight;
  Rgb value;
};

/// Structure of arrays, padded with samples of weight 0 to a multiple of kPadding, so that loops have no tails.
///
/// Values are multiplied by the square root of the weight, so that weighted sums of products are plain dot products.
class SliceSamples {
 public:
  static constexpr size_t kPadding = 16;

  explicit SliceSamples(std::span<const SliceSample> samples);

  size_t count() const { return count_; }  // without the padding
  size_t padded() const { return x_.size(); }
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }
  Vec3d wl(size_t i) const { return {x_[i], y_[i], z_[i]}; }
  const float* sqrt_weight() const { return sqrt_weight_.data(); }
  /// sqrt(weight) x channel `c` of f cos.
  const float* target(int c) const { return target_[c].data(); }

  /// Multiplies the weights by `factors`, one per sample. The energies remain those of the original weights.
  void scale_weights(std::span<const float> factors);

  /// Replaces the measured values of channel `c` by `values`, one per sample, multiplied by the square root of its
  /// weight. Does not change the energies.
  void replace_target(int c, const AlignedFloats& values) { target_[c] = values; }

  /// Sum of weight x luminance(f cos)^2.
  double luminance_energy() const { return luminance_energy_; }
  /// Relative L2 error of the luminance if every channel is fitted exactly except for its negative values, which
  /// non-negative coefficients cannot follow. No fit gets below it, and lobes spent on it are wasted.
  double gamut_error() const;
  /// Sum of weight x f cos^2 of one channel.
  double energy(int c) const { return energy_[c]; }

 private:
  size_t count_;
  AlignedFloats x_, y_, z_, sqrt_weight_, target_[3];
  double luminance_energy_ = 0, gamut_error_sq_ = 0, energy_[3] = {0, 0, 0};
};

}  // namespace velour
