// Fits nodes of Blender to a measured material: curves of a diffuse and up to three glossy lobes over the view angle.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closure_error.h"
#include "brdf/fit/closures/closures.h"

namespace velour {

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
  double azimuth_error = 0;                // mean error of the source's mean over the azimuths
};

/// Least squares on f cos and albedo at 36 views, each relative to its own norms (ClosureProblem), with more weight on
/// dim directions (emphasize_dim), by Levenberg-Marquardt. A network of K lobes starts from that of K - 1 lobes
/// (one_more_lobe). The smallest K with a visible error below the tolerance or within 10 % of the best is returned. At
/// last weights are scaled until albedos agree (ClosureAlbedo). Anisotropic sources are averaged over the azimuth of
/// the view, and errors are against all azimuths. Throws Error(invalid_argument) if an option is out of range, and
/// Error(cancelled) after a cancel. Black if the source is.
ClosureFit fit_closures(const ClosureSource& source, const ClosureFitOptions& options, Progress& progress);

}  // namespace velour
