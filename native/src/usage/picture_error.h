// Error of pictures rendered with a model in place of its measurement, from scene usage.
#pragma once

#include <vector>

#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "brdf/model/parametric_brdf.h"
#include "usage/observation.h"

namespace velour {

struct PictureErrorEstimate {
  double relmse = 0;  // may be negative if there is almost no error
  double standard_error = 0;
};

/// relmse of compare_pictures (image/picture.h), with a pixel for each observed hit: its reflected radiance with the
/// model against that with the measurement. Each hit has two independent estimates of its light, so the product of
/// their errors is an unbiased estimate of the squared error.
class PictureError {
 public:
  /// `stand_in` replaces the measurement at pairs that it does not cover.
  PictureError(const Measurement& measurement, const ParametricBrdf& stand_in, const SceneObservation& observation,
               int threads, const Progress& progress);

  /// Every other hit is used by refine_colors, the others judge the result, so that no hit judges its own fit.
  enum class Part { refined = 0, judged = 1 };
  /// Error of each hit of a part. The mean is the relmse; errors of two models can be compared hit by hit.
  std::vector<double> shares(const ParametricBrdf& model, Part part = Part::judged) const;

  /// Moves the coefficients of `model`, but not its shapes, by Gauss-Newton steps towards the minimum picture error,
  /// with a ridge that holds them near their values. The residual of f after a fit is small, but its mean over the
  /// lights of a picture need not be. As in shares(), residuals of one half are multiplied by slopes of the other, so
  /// that noise is not fitted. Changes nothing if that does not help. Control values stay half floats.
  void refine_colors(ParametricBrdf& model) const;

  static PictureErrorEstimate estimate(const std::vector<double>& shares);

 private:
  std::vector<size_t> hits_of(Part part) const;
  void step_colors(ParametricBrdf& model, double ridge) const;

  const SceneObservation& observation_;
  int threads_;
  const Progress& progress_;
  std::vector<Vec3d> measured_;  // f of each term
  std::vector<Vec3d> scale_;     // 1 / (r^2 + 0.01 mean(r)^2) / 3 of each hit
};

}  // namespace velour
