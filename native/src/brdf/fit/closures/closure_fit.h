// Fits nodes of Blender to a measured material: curves of a diffuse and up to three glossy lobes over the view angle.
#pragma once

#include <memory>
#include <string>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closures.h"
#include "brdf/measure/measurement.h"
#include "model/model.h"

namespace velour {

// Accuracy and energy of closures.

/// Relative L2 errors of f cos at views of one polar angle: one of an isotropic source, otherwise eight azimuths.
struct ClosureViewError {
  int degrees;  // theta_v
  double luminance, rgb;
  double root;  // of the roots of all channels: errors around highlights count, too
};

/// The source at views of kHeldOutViews, over 1024 lights that resolve its highlights.
class ClosureJudge {
 public:
  ClosureJudge(const ClosureSource& source, const HighlightWidths& widths, int threads, const Progress& progress);
  std::vector<ClosureViewError> errors(const ClosureNetwork& network, LobeMasking masking) const;

 private:
  std::vector<std::vector<ClosureTarget>> views_;  // an element per azimuth of each view
};

/// Mean luminance error of the views up to 75 degrees.
double mean_closure_error(const std::vector<ClosureViewError>& errors);
/// Mean of the luminance and root errors of those views: what pictures show, since lights that a highlight misses are
/// reflected by its surroundings.
double visible_closure_error(const std::vector<ClosureViewError>& errors);

/// Albedo of the source, a mean over azimuths, at the samples of ClosureCurve and halfway between them, at most 89.5
/// degrees.
class ClosureAlbedo {
 public:
  ClosureAlbedo(const ClosureSource& source, const HighlightWidths& widths, int threads, const Progress& progress);

  /// Scales the weights of each sample of the curves so that the albedo is within 1 % of the source's, unless that
  /// takes a factor above 1.25, and never more than 1 % above it between the samples either. Channels that reflect less
  /// than a hundredth of the largest albedo are only reduced.
  void correct(ClosureNetwork& network, LobeMasking masking) const;
  /// Largest share by which the albedo of a channel exceeds the source's; not negative. 0 for a black source.
  double largest_excess(const ClosureNetwork& network, LobeMasking masking) const;

 private:
  Vec3d albedo_of(const ClosureNetwork& network, LobeMasking masking, size_t view) const;

  std::vector<std::vector<ClosureLights>> views_;  // an element per azimuth of each view
  std::vector<Vec3d> albedo_;                      // of the source at each view
  double largest_ = 0;
};

struct ClosureFitOptions {
  double tolerance = 0.03;  // visible_closure_error() with which no more lobes are added
  int max_lobes = 3;        // in [1, 3]
  LobeMasking masking = LobeMasking::separable;
  int threads = 0;  // 0: all; the result does not depend on it
};

struct ClosureFit {
  ClosureNetwork network{};
  LobeMasking masking = LobeMasking::separable;
  std::vector<ClosureViewError> errors{};  // at 5, 30, 60, 75 and 85 degrees
  double mean_error = 0;                   // mean of luminance errors up to 75 degrees
  double albedo_excess = 0;                // largest share by which an albedo exceeds the source's
};

/// Least squares on f cos and albedo at 36 views, each relative to its own norms (ClosureProblem), with more weight on
/// dim directions (emphasize_dim), by Levenberg-Marquardt. A network of K lobes starts from that of K - 1 lobes
/// (one_more_lobe). The smallest K with a visible error below the tolerance or within 10 % of the best is returned. At
/// last weights are scaled until albedos agree (ClosureAlbedo). An anisotropic source is fitted in the frame of the
/// surface, at two azimuths per polar angle. Throws Error(invalid_argument) if an option is out of range, and
/// Error(cancelled) after a cancel. Black if the source is.
ClosureFit fit_closures(const ClosureSource& source, const ClosureFitOptions& options, Progress& progress);

// Closures of a model or a measurement.

struct ModelClosures {
  ClosureFit fit;
  double seconds = 0;  // wall clock
  std::string reason;  // a sentence if the error is large
};

/// fit_closures() of a BRDF model. Throws Error(unsupported) for a model of a BTF, and what fit_closures() throws.
ModelClosures fit_model_closures(const std::shared_ptr<const Model>& model, const ClosureFitOptions& options,
                                 Progress& progress);

/// fit_closures() of a measurement. Directions that it does not cover are black.
ModelClosures fit_measurement_closures(const Measurement& measurement, const ClosureFitOptions& options,
                                       Progress& progress);

}  // namespace velour
