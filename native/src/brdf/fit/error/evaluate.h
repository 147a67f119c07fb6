// Evaluates a material at any number of light directions; lists the views at which errors are reported.
#pragma once

#include <memory>
#include <span>
#include <vector>
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "math/sphere/view_spline.h"

namespace velour {

/// f (1/sr, no cosine) of `material` and the density (1/sr) of its sampler, for one view and each of `wl`. Either
/// output may be empty and is then skipped.
void evaluate(const Material& material, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
              std::span<float> density = {});

/// Views that represent one reported polar angle (degrees): one on the meridian if isotropic, otherwise eight azimuths.
std::vector<Vec3> reported_views(int degrees, bool isotropic);

/// The reported view (degrees) that an irregular sample at `wv` counts for: the nearest within kHeldOutGroup, or -1.
int reported_view_of(const Vec3& wv);

// A material as a measurement, for fits and comparisons of models.

/// f of `material`, or its mean over the surface if it varies. Every pair above the horizon is covered. Immutable.
class MaterialMeasurement final : public Measurement {
 public:
  /// `views`: range of views that the material is valid for.
  explicit MaterialMeasurement(std::shared_ptr<const Material> material, const ViewRange& views = {});

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override;
  bool isotropic() const override { return material_->isotropic(); }
  bool covers_view(float theta_v) const override;

 private:
  std::shared_ptr<const Material> material_;
  ViewRange views_;
};

}  // namespace velour
