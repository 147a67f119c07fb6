// The lobes of a parametric model at any view: its splines, evaluated exactly.
#pragma once

#include <vector>
#include "brdf/eval/view_nodes.h"
#include "brdf/model/parametric_brdf.h"
#include "math/sphere/view_spline.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

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

}  // namespace velour
