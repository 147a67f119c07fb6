// The lobes that a material has at a view, before they are Gaussians of light.
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
  /// As many at every view.
  virtual std::vector<ReachedLobe> lobes(const Vec3d& wv) const = 0;
  /// What lobe `j` of `lobes`(wv) is at `wl` over what it is there as a Gaussian of its argument.
  virtual Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const = 0;
  /// f of those lobes that are `soft`, and whatever no lobe reflects.
  virtual Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const = 0;
};

/// Of a symmetric model there are twice its lobes: those of the view, then those of the light. `brdf` has to outlive
/// it.
std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf);
std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters);

}  // namespace velour
