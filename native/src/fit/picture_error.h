// How wrong pictures are with a model in place of its measurement, as scenes showed the material.
#pragma once

#include <vector>

#include "brdf/measurement.h"
#include "brdf/parametric_brdf.h"
#include "domain/observation.h"
#include "job/progress.h"

namespace velour {

struct PictureErrorEstimate {
  double relmse = 0;  // may come out below 0 where there is next to no error
  double standard_error = 0;
};

/// relmse of compare_pictures (image/picture.h), with a pixel for each observed hit: the light that leaves it by the
/// model against that by the measurement. Each hit has two independent sums over its light; the product of their
/// errors is free of their noise on average.
class PictureError {
 public:
  /// Where the measurement does not cover a pair, `stand_in` speaks for it.
  PictureError(const Measurement& measurement, const ParametricBrdf& stand_in, const SceneObservation& observation,
               int threads, const Progress& progress);

  /// Every other hit serves refine_colors, the others judge: what was moved to suit a hit is not judged by it.
  enum class Part { refined = 0, judged = 1 };
  /// The share of each hit of a part. Their mean is the error; shares of two models may be compared hit by hit.
  std::vector<double> shares(const ParametricBrdf& model, Part part = Part::judged) const;

  /// Moves the coefficients of `model` (its shapes stay) by Gauss-Newton steps towards the least error of pictures,
  /// held near where they are by a ridge: what is left of the error of f after a fit is small, but its mean over the
  /// lights of a picture need not be. As in shares(), residuals of one half meet slopes of the other, so that the noise
  /// of the sums is not fitted. Unchanged where that does not help. Control values are half floats.
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
