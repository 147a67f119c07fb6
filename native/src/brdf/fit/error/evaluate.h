// Evaluates a material at any number of light directions, or under uniform light; lists the views of all reports.
#pragma once

#include <memory>
#include <span>
#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "brdf/model/parametric_brdf.h"
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

// Directional albedo: the radiance reflected to a view under uniform light of radiance 1.

/// Integral of f cos over the light directions, per channel.
Vec3d directional_albedo(const Material& material, const Vec3& wv);

struct MeasuredAlbedo {
  Vec3d albedo{0};     // over the light directions that the measurement covers
  double covered = 0;  // their share of the integral of the cosine
};
MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv);

// Limits the directional albedo of a parametric model to 1.

/// Lowers the coefficients of `brdf` until no channel of its directional albedo exceeds 1, tested at views half a
/// degree apart. f does not change at views beyond the spline support of those that exceed 1. Control values stay half
/// floats. Returns whether anything changed.
bool limit_albedo(ParametricBrdf& brdf, int threads, const Progress& progress);

}  // namespace velour
