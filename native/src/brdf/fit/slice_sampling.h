// Samples a measurement at the slices that are fitted: views, their light directions, and f cos(theta_l) there.
#pragma once

#include <oneapi/tbb/cache_aligned_allocator.h>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/direction_tree.h"
#include "brdf/measure/measurement.h"
#include "math/sphere/vec.h"

namespace velour {

// Samples of one slice for the solver: f cos(theta_l) of one view at weighted light directions.

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

// The views that a fit samples, and their light directions.

/// Views of a fit, unit. Isotropic: on the meridian phi_v = 0, sorted by theta_v, in steps of about two degrees.
/// Otherwise an equal-area lattice over the hemisphere. None lies within kHeldOutMargin of a held-out view's polar
/// angle unless `all_data`.
std::vector<Vec3> meridian_views(bool all_data);
std::vector<Vec3> hemisphere_views(bool all_data);

/// Light directions of the view `wv` with their solid angles, as a product grid of half vectors: theta_h in quadratic
/// steps, so that the highlight is sampled as finely as MERL tabulates it, phi_h uniform, each ring rotated against the
/// previous one. d wl = 4 (wv . h) d h. Lights at or below the horizon are left out.
struct LightGrid {
  std::vector<Vec3> wl;
  std::vector<float> weight;   // sr
  std::vector<uint32_t> ring;  // index of the light's ring, which has equal theta_h
};
LightGrid light_grid(const Vec3& wv, int rings = 96, int spokes = 64);

/// Distributes the solid angle of the lights that are not `kept` to the kept ones of their ring.
void redistribute_weights(LightGrid& grid, std::span<const uint8_t> kept);

/// The slice of one view, and facts about its samples.
struct MeasuredSlice {
  Vec3 wv;
  std::vector<SliceSample> samples;
  double weight = 1;          // weight of the view's squared error in a fit of all views together
  double energy = 0;          // sum of weight x luminance(f cos)^2 that errors are relative to; 0: that of the samples
  double fold = 0;            // relative L2 error of folding (SliceGrid::folded)
  bool interpolated = false;  // from irregular samples, which the fit also reads directly
  std::shared_ptr<const DirectionTree> lights = nullptr;  // of tables: the cells that the samples represent
  size_t out_of_gamut = 0;  // samples with a negative channel: kept, although no model of ours can follow them
};

struct MeasuredSlices {
  std::vector<MeasuredSlice> slices;  // views with samples only
  std::vector<Vec3> uncovered;        // views left out because the measurement does not cover them
};

/// Light directions of a view.
struct SliceGrid {
  int parts;          // of a DirectionTree; 0, or irregular samples, whose interpolation is slow: a light grid
  int rings, spokes;  // of the light grid (LightGrid)
  /// Isotropic data: only lights on one side of the plane of incidence, each with the mean of its value and that of its
  /// mirror image (for a view along the normal, the mean over azimuths). For models that are symmetric about that
  /// plane, which get the same fit from half the samples.
  bool folded = false;
};

/// Samples every view that `source` covers at its own lights. `hold_out` leaves out the held-out views and one light in
/// eight. Pairs that the measurement does not cover are left out, never taken for black. `threads` 0: all.
MeasuredSlices sample_slices(const Measurement& source, const SliceGrid& grid, bool hold_out, int threads,
                             Progress& progress);

}  // namespace velour
