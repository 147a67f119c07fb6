// A material as a measurement, for fits and comparisons of models.
#pragma once

#include <memory>

#include "brdf/measurement.h"
#include "material/material.h"
#include "sphere/view_range.h"

namespace velour {

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
