// Fits nodes of Blender to a measured material: curves of a diffuse and up to three glossy lobes over the view angle.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closure_samples.h"
#include "brdf/fit/closures/closures.h"
#include "material/material.h"

namespace velour {

struct ClosureFitOptions {
  double tolerance = 0.04;  // mean error with which no more lobes are added
  int max_lobes = 3;        // in [1, 3]
  LobeMasking masking = LobeMasking::separable;
  bool tilt = true, anisotropy = true;
  /// No anisotropy at theta_v = 0, where the tangent has no direction: otherwise a sphere shows a dark pinwheel there.
  /// Measurements with stretched lobes at the normal lose a few points of accuracy at 5 degrees.
  bool pin_anisotropy = true;
  /// Keeps normals where Cycles does not bend them. Unnecessary without the material's bump map correction.
  bool limit_tilt = true;
  bool beckmann = true;     // also try a Beckmann lobe as the second of three
  double min_alpha = 0.02;  // in [0.002, 0.5]; light directions resolve no narrower lobes than about 0.02
  int threads = 0;          // 0: all; the result does not depend on it
};

/// Relative L2 error of f cos over 4096 equal-area lights. They resolve narrow highlights poorly: at alpha 0.06 an
/// error of 6 % may read as 8 %.
struct ClosureViewError {
  int degrees;  // theta_v
  double luminance, rgb;
};

/// Model over material, minus 1, for each channel; 0 where the material is black.
struct ClosureAlbedoError {
  double degrees;  // theta_v
  Rgb relative;
};

struct ClosureFit {
  ClosureNetwork network{};
  LobeMasking masking = LobeMasking::separable;
  std::vector<ClosureViewError> errors{};    // at 5, 30, 60, 75 and 85 degrees
  double mean_error = 0;                     // mean of luminance errors up to 75 degrees
  std::vector<ClosureAlbedoError> albedo{};  // at the 36 fitted views
  double largest_cut = 0;                    // largest share of a weight removed to keep the albedo
};

/// Least squares on f cos and albedo at 36 views, each relative to its own norms (ClosureProblem), by
/// Levenberg-Marquardt. A network of K lobes starts from the best of K - 1 lobes and one more that is narrower, wider
/// or points at the viewer. The smallest K with a mean error below the tolerance or within 10 % of the best is
/// returned. Then weights are reduced where the albedo of a channel exceeds the material's by more than 1 %.
/// Anisotropic materials are averaged over the azimuth of the view, varying ones over the surface. Throws
/// Error(invalid_argument) if an option is out of range, and Error(cancelled) after a cancel. Black if the material is.
ClosureFit fit_closures(const Material& material, const ClosureFitOptions& options, Progress& progress);
ClosureFit fit_closures(const ClosureSource& source, bool isotropic, const ClosureFitOptions& options,
                        Progress& progress);

}  // namespace velour
