// Error of a model over a set of light directions. The only definition of that error.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sphere/vec.h"

namespace velour {

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

}  // namespace velour
