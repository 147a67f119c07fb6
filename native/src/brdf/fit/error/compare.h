// Error of a model against a measurement, as docs/engine/conventions.md defines it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/direction_tree.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "math/sphere/vec.h"
#include "model/model.h"

namespace velour {

/// Errors of views, and their standard errors: how far other directions would move them.
struct Comparison {
  double relative_l2 = 0;  // mean over the covered views weighted by cos(theta_v); 1 if no view is covered
  double standard_error = 0;
  ErrorByViewAngle by_view_angle, standard_error_by_view_angle;
  double log_rms = 0;                    // RMS of log(1 + f cos / 0.01) differences over the solid angle
  ErrorByViewAngle noise_by_view_angle;  // the measurement's own noise from mirror and reciprocal pairs
  /// Tables only: share of the light directions above the horizon that the measurement covers. Errors are over these.
  std::map<int, double> covered_share;
  uint64_t samples = 0;
};

/// Error at the held-out views 5, 30, 60, 75 and 85 degrees; for irregular samples, at the held-out ones. Tables:
/// several independent sets of error_lights(), more of them until the standard error is at most 5 % of the error or of
/// one in a thousand. A view with less than 1/64 of its light directions covered has none.
Comparison compare(const Measurement& measurement, const Material& material, Progress& progress);

/// Directions for the error of `material` at `wv`: 1200 of the measurement's `tree`, and 400 of the material's own
/// sampler, which find narrow lobes of the material anywhere. Each weight is one over the summed densities of both: the
/// balance heuristic [VG95]. Sets of different numbers are independent.
WeightedLights error_lights(const DirectionTree& tree, const Material& material, const Vec3& wv, uint64_t set);

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
    const double logs = log_value(m) - log_value(f);
    log_sq_ += weight * logs * logs;
    solid_angle_ += weight;
    ++count_;
  }
  void add(const ViewError& other) {
    error_sq_ += other.error_sq_;
    energy_ += other.energy_;
    log_sq_ += other.log_sq_;
    solid_angle_ += other.solid_angle_;
    count_ += other.count_;
  }

  uint64_t count() const { return count_; }
  /// Weighted relative L2; a black measurement gives 0 for a black model and 1 for any other.
  double relative_l2() const { return energy_ > 0 ? std::sqrt(error_sq_ / energy_) : (error_sq_ > 0 ? 1.0 : 0.0); }
  double log_sq_sum() const { return log_sq_; }
  double solid_angle() const { return solid_angle_; }  // sum of the weights
  /// Integral of the squared error less `ratio` times that of the squared measurement.
  double beyond(double ratio) const { return error_sq_ - ratio * energy_; }
  double energy() const { return energy_; }

 private:
  /// log(1 + f cos / 0.01), clamped because a color outside the gamut may be negative.
  static double log_value(double f_cos) { return std::log1p(std::max(f_cos, 0.0) / 0.01); }

  double error_sq_ = 0, energy_ = 0, log_sq_ = 0, solid_angle_ = 0;
  uint64_t count_ = 0;
};

/// The error of independent sets of directions together, and its standard error: that of a ratio of means [Coc77].
struct ErrorEstimate {
  double error = 0, standard_error = 0;
};
ErrorEstimate error_estimate(std::span<const ViewError> sets);

}  // namespace velour
