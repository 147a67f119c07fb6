// The lobes of a material at a view, before their conversion to Gaussians over light directions.
#pragma once

#include <memory>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "material/principled_point.h"
#include "realtime/light_gaussians.h"

namespace velour {

class LobesOfViews {
 public:
  virtual ~LobesOfViews() = default;
  virtual LobeOf of() const = 0;
  /// The lobes at a view; their number is the same at every view.
  virtual std::vector<ReachedLobe> lobes(const Vec3d& wv) const = 0;
  /// Ratio of lobe `j` of `lobes(wv)` at `wl` to the Gaussian of its argument there.
  virtual Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const = 0;
  /// f of the lobes marked in `soft`, plus everything that no lobe reflects.
  virtual Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const = 0;
};

/// A symmetric model has twice its lobes here: those of the view, then those of the light. `brdf` must outlive the
/// result.
std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf);
std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters);

}  // namespace velour
