// The lobes of a parametric model at any view: its splines, evaluated exactly.
#pragma once

#include <vector>

#include "brdf/parametric_brdf.h"
#include "material/view_place.h"
#include "srbf/warped_mixture.h"

namespace velour {

/// The model's coefficients, laid out for lanes over lobes: what ParametricTable is made from, and what evaluates where
/// no table is. Immutable; thread-safe; no allocation.
class ParametricValues {
 public:
  /// Throws Error(invalid_argument) when there are more lobes than WarpedMixture::kCapacity.
  explicit ParametricValues(const ParametricBrdf& brdf);

  bool isotropic() const { return spline_.isotropic(); }
  const ViewSpline& spline() const { return spline_; }
  int count() const { return count_; }
  int padded_count() const { return padded_; }
  /// 1 for lobes of half space, of the padded number.
  const std::vector<float>& half() const { return half_; }
  uint64_t bytes() const { return sizeof(float) * (control_.size() + half_.size()); }

  /// Fills in the frame, the parameterisations and the lobes of the value (not those of the density) at unit `wv`,
  /// which is at `place`, above or on the horizon. Lobes of isotropic models lie in the view's frame: x along its
  /// azimuth. Run-time dispatched SIMD. Relative to lobes_at: 1e-5 in bandwidths and coefficients, 1e-6 radians in
  /// centres, where the model's splines change by a few units a cell.
  void evaluate(const Vec3& wv, const ViewPlace& place, WarpedMixture& mixture) const;

 private:
  ViewSpline spline_;
  int count_, padded_;
  std::vector<float> half_;
  std::vector<float> control_;  // [node][parameter][padded lobe]
};

}  // namespace velour
