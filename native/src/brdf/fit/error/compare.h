// Error of a model against a measurement, as docs/engine/conventions.md defines it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "math/sphere/vec.h"
#include "model/model.h"

namespace velour {

struct Comparison {
  double relative_l2 = 0;  // mean over the covered views weighted by cos(theta_v); 1 if no view is covered
  ErrorByViewAngle by_view_angle;
  double log_rms = 0;                    // RMS of log(1 + f cos / 0.01) differences
  ErrorByViewAngle noise_by_view_angle;  // the measurement's own noise from mirror and reciprocal pairs
  /// Tables only: share of the light directions above the horizon that the measurement covers. Errors are over these.
  std::map<int, double> covered_share;
  uint64_t samples = 0;
  /// Views with a highlight too narrow for the 4096 directions: share of the measurement's energy that they capture.
  std::map<int, double> narrow_views;
};

/// Error at the held-out views 5, 30, 60, 75 and 85 degrees on 4096 equal-area light directions each; for irregular
/// samples, at the held-out ones. If the 4096 directions misjudge the energy of the measurement, if fewer than two of
/// them carry it, or if they understate the error (a narrow lobe of the model falls between them), the error of the
/// view is taken on close_lights() and the view is listed in `narrow_views`.
Comparison compare(const Measurement& measurement, const Material& material, Progress& progress);

// Noise of a measurement, from pairs of values that are equal by physics.

/// Relative noise of the luminance of f cos at one reported view (one of kHeldOutViews), in the units of relative_l2:
/// the RMS difference of paired values over sqrt(2), divided by their RMS. Pairs are mirror images about the plane of
/// incidence (isotropic only) and reciprocal directions. Returns the larger of the two estimates, because a table that
/// stores both members of a pair as one entry shows no noise there. Irregular samples: pairs of samples within one
/// degree of each other after either symmetry. Nothing if there are no pairs.
std::optional<double> noise_of_view(const Measurement& measurement, int degrees, const Progress& progress);

// Error of a model over a set of light directions. The only definition of that error.

/// Running sums of one view: luminance of f cos(theta_l), weighted by solid angle.
class ViewError {
 public:
  /// `measured` and `model` are f (1/sr, no cosine), `cosine` is that of the light.
  void add(double weight, const Rgb& measured, const Rgb& model, double cosine) {
    const double m = luminance(measured) * cosine, f = luminance(model) * cosine;
    error_sq_ += weight * (m - f) * (m - f);
    energy_ += weight * m * m;
    squared_energy_ += weight * m * m * weight * m * m;
    const double logs = log_value(m) - log_value(f);
    log_sq_ += logs * logs;
    ++count_;
  }

  uint64_t count() const { return count_; }
  /// Weighted relative L2; a black measurement gives 0 for a black model and 1 for any other.
  double relative_l2() const { return energy_ > 0 ? std::sqrt(error_sq_ / energy_) : (error_sq_ > 0 ? 1.0 : 0.0); }
  double log_sq_sum() const { return log_sq_; }
  /// Energy of the measurement: the integral of (f cos)^2.
  double energy() const { return energy_; }
  /// Effective number of directions that carry the energy: all of them if it is uniform, 1 if one has it all.
  double carriers() const { return energy_ > 0 ? energy_ * energy_ / squared_energy_ : static_cast<double>(count_); }

 private:
  /// log(1 + f cos / 0.01), clamped because a color outside the gamut may be negative.
  static double log_value(double f_cos) { return std::log1p(std::max(f_cos, 0.0) / 0.01); }

  double error_sq_ = 0, energy_ = 0, squared_energy_ = 0, log_sq_ = 0;
  uint64_t count_ = 0;
};

// Light directions dense enough to resolve any highlight.

/// Directions above the horizon and the solid angles (sr) that they represent.
struct WeightedLights {
  std::vector<Vec3> wl;
  std::vector<double> weight;
};

/// Sizes of the sets of close_lights.
struct LightCounts {
  int even = 4096, rings = 72, spokes = 40, own = 2048;
};

/// Directions for the error of `material` at the view `wv`: equal-area directions, rings about the mirror direction of
/// `wv` and about `wv` itself, and directions from the material's own sampler. The radii of the rings grow
/// geometrically from 1e-4 radians, so the two places where measured materials are sharp are resolved at every scale.
/// The sampled directions resolve narrow lobes of the material anywhere. Each weight is one over the summed densities
/// of the four sets: the balance heuristic [VG95] as a quadrature.
WeightedLights close_lights(const Material& material, const Vec3& wv, const LightCounts& counts = {});

}  // namespace velour
