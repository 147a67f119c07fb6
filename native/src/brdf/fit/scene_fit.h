// Fits a scene model: a parametric model reduced to scene usage.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/fit_model.h"
#include "usage/observation.h"

namespace velour {

/// The smallest parametric model found whose pictures, for the scene usage options.for_scene, are no worse than those
/// of the full model. It has fewer lobes and cells over a range of views; its fit is weighted by the observed views and
/// light directions. The full model is options.full_model, or is fitted first. If nothing smaller is good enough, the
/// full model's lobes are returned. The model has a SceneRecord and is not valid beyond its views
/// (usage/observation.h).
///
/// Throws Error(invalid_argument) if nothing was observed or the full model is not parametric or is itself reduced, and
/// Error(unsupported) for anisotropic measurements, because scene usage does not record azimuths.
Model fit_for_scene(const Measurement& measurement, const FitOptions& options, Progress& progress);

// Distribution of incident light over directions, from scene usage.

/// Mean incident radiance of the observed hits by direction, relative to its mean over the hemisphere and clamped to
/// 0.1..10, so that no direction is left out of a fit. Binned by polar angle and by azimuth relative to the view, which
/// suffices for isotropic materials.
class LightImportance {
 public:
  explicit LightImportance(const SceneObservation& observation);

  double operator()(const Vec3& wv, const Vec3& wl) const { return value_[bin(wv, wl)]; }

 private:
  static constexpr int kRings = 8, kSpokes = 12;  // rings of equal solid angle
  static size_t bin(const Vec3& wv, const Vec3& wl);

  std::vector<double> value_;
};

}  // namespace velour
