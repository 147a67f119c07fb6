// The lobes of a parametric model at any view: from its splines, or from a table that costs only a few sums.
#pragma once

#include <oneapi/tbb/cache_aligned_allocator.h>
#include <cstdint>
#include <span>
#include <vector>
#include "brdf/eval/view_nodes.h"
#include "brdf/model/parametric_brdf.h"
#include "math/sphere/view_spline.h"
#include "math/srbf/lobe_products.h"
#include "math/srbf/warped_lobe.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

// The lobes of a parametric model at any view: its splines, evaluated exactly.

/// The model's coefficients, laid out for SIMD over lobes. ParametricTable is built from them; views that it does not
/// cover are evaluated here. Immutable; thread-safe; no allocation.
class ParametricValues {
 public:
  /// Throws Error(invalid_argument) when there are more lobes than WarpedMixture::kCapacity.
  explicit ParametricValues(const ParametricBrdf& brdf);

  bool isotropic() const { return spline_.isotropic(); }
  const ViewSpline& spline() const { return spline_; }
  int count() const { return count_; }
  int padded_count() const { return padded_; }
  /// 1 for half-vector lobes, else 0; padded_count() entries.
  const std::vector<float>& half() const { return half_; }
  uint64_t bytes() const { return sizeof(float) * (control_.size() + half_.size()); }

  /// Sets the frame, the parameterizations and the lobes of the value (not of the density) at unit `wv`, on or above
  /// the horizon; `place` is ViewPlace(wv). Lobes of isotropic models are in the view's frame: x along its azimuth.
  /// SIMD, dispatched at run time. Deviates from lobes_at by 1e-5 (relative) in bandwidths and coefficients and 1e-6
  /// radians in centers, for splines that change by a few units per cell.
  void evaluate(const Vec3& wv, const ViewPlace& place, WarpedMixture& mixture) const;

 private:
  ViewSpline spline_;
  int count_, padded_;
  std::vector<float> half_;
  std::vector<float> control_;  // [node][parameter][padded lobe]
};

// Rows of a parametric model's coefficients that are mixed for a view.

inline constexpr float kLog2E = 1.44269504f;

/// Input of the SIMD kernel: rows of [parameter][lobe] and their weights.
struct SplineRows {
  static constexpr int kIsotropicTaps = 3;
  const float* half;     // 1 for half-vector lobes, else 0
  const float* control;  // the first row
  int stride;            // from one parameter to the next
  int row;               // from one row to the next
  float stretch;         // factor of the stretches: pole_fade
  ViewTapsOf<float> taps;
};

// A parametric model at evenly spread views: which of its lobes matter, and a few Gaussians that resemble f cos.

// Quadrature over light directions adapted to a mixture of warped lobes.

/// Stratified samples of every lobe and of the cosine, in the lobes' frame, with each lobe's kernel at each sample.
/// Accurate to a few per cent.
class LightPoints {
 public:
  /// Uses only the value of `mixture`, not its density.
  explicit LightPoints(const WarpedMixture& mixture);

  size_t size() const { return light_.size(); }
  /// The integral of the luminance of f cos over the hemisphere.
  double mass() const { return mass_; }
  const Vec3& light(size_t i) const { return light_[i]; }
  double value(size_t i) const { return value_[i]; }          // luminance of f
  double per_value(size_t i) const { return per_value_[i]; }  // 1 / value; 0 where that is 0
  double weight(size_t i) const { return weight_[i]; }        // part of the mass
  double kernel(size_t i, int lobe) const { return static_cast<double>(kernel_[lobe][i]); }

 private:
  void add(const WarpedMixture& even, const DirectionBatch& wl);

  std::vector<Vec3> light_;
  std::vector<double> value_, per_value_, weight_;
  double mass_ = 0;
  std::vector<float> kernel_[WarpedMixture::kCapacity];  // peak 1
};

/// The lobes of a mixture's value as WarpedLobes, in the mixture's frame.
std::vector<WarpedLobe> lobes_of(const WarpedMixture& mixture);

/// Immutable; thread-safe; no allocation after construction.
class ParametricNodes {
 public:
  explicit ParametricNodes(const ParametricValues& values);

  /// Gaussians over light directions that approximate f cos at `wv`, in the surface's frame. They match the moments of
  /// each lobe's part at the nearest node, are merged to a few, and rotate with the view's mirror direction.
  void propose(const Vec3& wv, ProposalLobes& lobes) const;

  /// Bit mask of the lobes that matter at any node from the one before `first` to the one after `last`,
  /// on a meridian of an isotropic model.
  uint32_t matter_between(const ViewPlace& first, const ViewPlace& last) const;

 private:
  void fill_node(const ParametricValues& values, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<ProposalLobes> proposals_;  // per node, in the lobes' frame
  std::vector<uint32_t> matter_;          // per node
};

// Finds lobes that are negligible at a view.

/// Limits for all lobes dropped at a view together, as fractions of the albedo, of the L2 norm of f cos, and of f
/// itself at every light direction.
inline constexpr double kIdleAlbedo = 1e-3, kIdleNorm = 1e-3, kIdleValue = 1e-2;

/// Bit mask of the lobes to keep, up to 32, judged at `points`, the quadrature of `lobes` at the view. Lobes are
/// dropped in order of increasing loss, which compares a lobe's largest channel with the luminance of all lobes, until
/// the next one would exceed these limits.
uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points);

// An isotropic parametric model, tabulated so that a view costs only a few sums.

/// Indices of lobes.
struct LobeList {
  uint8_t lobe[WarpedMixture::kCapacity];
  uint8_t count = 0;
};

/// Input of the SIMD kernel.
struct TableRows {
  const float *half, *control;
  const LobeList* lists;
  const ViewSpline& spline;
};

/// Evaluated lobe parameters (no logarithms, no angles) as quadratic splines of the view over about 320 intervals,
/// whose ends include the model's own knots: 165 KB for up to 16 lobes, 83 KB for up to 8. f is that of
/// ParametricValues without the lobes that are negligible at the view (ParametricNodes), to within 1e-3 of itself
/// plus 1e-6 of its peak on the test models (at worst 1.4e-3 on measured materials: docs/engine/parametric_model.md),
/// once differentiable in the view and never negative. Immutable; thread-safe; no allocation.
class ParametricTable {
 public:
  /// Empty for anisotropic models: tables over the disk of views would be too large for the cache.
  ParametricTable(const ParametricValues& values, const ParametricNodes& nodes);

  /// False near the normal, where stretches fade within a degree or two, and for anisotropic models.
  bool covers(const Vec3& wv) const { return wv.z <= most_z_; }
  /// Like ParametricValues::evaluate, at a covered view.
  void evaluate(const Vec3& wv, WarpedMixture& mixture) const;

  uint64_t bytes() const { return sizeof(float) * (rows_.size() + half_.size()) + sizeof(LobeList) * lists_.size(); }
  /// Columns of a row, each as long as the padded number of lobes.
  enum Column { kX, kZ, kSxx, kSyy, kBandwidth, kRed, kGreen, kBlue, kColumns };

 private:
  void fill(const ParametricValues& values);
  /// Lists the lobes that matter in each interval and zeroes the coefficients of the others, node by node.
  void leave_out_idle(const ParametricNodes& nodes);
  float& at(size_t node, int column, int lobe) {
    return rows_[(node * kColumns + static_cast<size_t>(column)) * static_cast<size_t>(padded_) +
                 static_cast<size_t>(lobe)];
  }

  int count_, padded_;
  float most_z_;
  ViewSpline spline_;
  std::vector<float> half_;
  std::vector<float, oneapi::tbb::cache_aligned_allocator<float>> rows_;  // [node][column][padded lobe]
  std::vector<LobeList> lists_;  // [node]: lobes for views that depend on this node and the next two
};

}  // namespace velour
